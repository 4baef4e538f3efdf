// A pigment slab against an independent polarized Monte Carlo, from the particles on.

#include <cmath>
#include <span>

#include "patina/coating/optical_problem.h"
#include "patina/core/constants.h"
#include "patina/jobs/validation/benchmark.h"
#include "patina/jobs/validation/paint_slab_data.h"

namespace patina::jobs::validation {

namespace {

rt::Problem slab_problem(bool interface) {
    return coating::optical_problem(coating::parse_recipe(paint_slab::recipe(interface), "paint slab", "."), 550.0,
                                    1e-6)
        .problem;
}

void run_slab(const rt::Solver* solver, bool interface, std::span<const paint_slab::Row> rows, Comparison& comparison) {
    std::vector<RadianceValue> values;
    for (const paint_slab::Row& row : rows)
        for (int s = 0; s < 4; ++s)
            values.push_back({0.0, true, std::cos(radians(row.theta_o_deg)), row.phi_deg, s, row.stokes[s],
                              3.0 * row.sigma[s] + 1e-5 * row.stokes[0]});
    const double mu_i = std::cos(radians(45.0));
    compare_field(*solver, slab_problem(interface), mu_i, 1.0 / (pi * mu_i), {.streams = 20, .samples = 300'000},
                  values, comparison);
}

}  // namespace

std::vector<Benchmark> paint_slab_benchmarks() {
    std::vector<Benchmark> result;
    for (const bool interface : {false, true}) {
        Benchmark benchmark{
            interface ? "Paint slab under an interface" : "Paint slab, index matched",
            "polarized Monte Carlo from electric-field amplitudes, made for this project (docs/theory.md)",
            "Stokes BRDF of TiO2-like paint at 45 deg incidence, 25 directions, from a composition recipe",
            "3 of its standard errors and 1e-5 of I, what its 512 size classes leave",
            {slab_problem(interface)},
            {}};
        benchmark.run = [interface](const rt::Solver* solver, Comparison& comparison) {
            if (interface)
                run_slab(solver, true, paint_slab::case_b, comparison);
            else
                run_slab(solver, false, paint_slab::case_a, comparison);
        };
        result.push_back(std::move(benchmark));
    }
    return result;
}

}  // namespace patina::jobs::validation
