// Natraj, Li & Yung (2009): conservative Rayleigh layers over a Lambertian base.

#include <cmath>

#include <fmt/format.h>

#include "patina/jobs/validation/benchmark.h"
#include "patina/jobs/validation/natraj2009_data.h"

namespace patina::jobs::validation {

namespace {

optics::ExpansionCoefficients rayleigh() {
    optics::ExpansionCoefficients x;
    x.alpha1 = {1, 0, 0.5};
    x.alpha2 = {0, 0, 3};
    x.alpha3 = {0, 0, 0};
    x.alpha4 = {0, 1.5, 0};
    x.beta1 = {0, 0, std::sqrt(6.0) / 2};
    x.beta2 = {0, 0, 0};
    return x;
}

rt::Problem layer(double optical_thickness, double reflectance) {
    return {1.0, {{optical_thickness, 1.0, rayleigh(), 1.0}}, rt::LambertianBase{reflectance}};
}

// Their Q and U have the opposite sign.
void run_layer(const rt::Solver* solver, double optical_thickness, double reflectance, Comparison& comparison) {
    for (const double mu_i : {0.2, 0.6, 1.0}) {
        std::vector<RadianceValue> values;
        for (const auto& row : natraj2009::radiances) {
            if (row.optical_thickness != optical_thickness || row.reflectance != reflectance || row.mu_i != mu_i)
                continue;
            const double published[3] = {row.i, -row.q, -row.u};
            for (int s = 0; s < 3; ++s)
                values.push_back(
                    {row.upward ? 0.0 : optical_thickness, row.upward, row.mu_o, row.phi_deg, s, published[s], 1e-6});
        }
        compare_field(*solver, layer(optical_thickness, reflectance), mu_i, 1.0, {.streams = 24, .samples = 200'000},
                      values, comparison);
    }
}

}  // namespace

std::vector<Benchmark> rayleigh_benchmarks() {
    std::vector<Benchmark> result;
    for (const double reflectance : {0.0, 0.8}) {
        Benchmark benchmark{fmt::format("Rayleigh layers, Lambert base {:g}", reflectance),
                            "Natraj, Li & Yung (2009), Astrophys. J. 691, 1909 (corrected Coulson-Dave-Sekera tables)",
                            "Stokes radiances at top and bottom, optical thickness 0.5 and 1, conservative",
                            "1e-6, though printed to 1e-8: grazing directions at 24 streams",
                            {layer(0.5, reflectance)},
                            {}};
        benchmark.run = [reflectance](const rt::Solver* solver, Comparison& comparison) {
            for (const double optical_thickness : {0.5, 1.0})
                run_layer(solver, optical_thickness, reflectance, comparison);
        };
        result.push_back(std::move(benchmark));
    }
    return result;
}

}  // namespace patina::jobs::validation
