#include "patina/jobs/body_solution.h"

#include <algorithm>
#include <cmath>

#include "patina/core/constants.h"
#include "patina/rt/once_scattered.h"

namespace patina::jobs {

namespace {

// The closed forms of a truncated problem.
std::vector<brdf::OnceScattered> closed_forms(const rt::Truncation& truncation) {
    std::vector<double> mu;
    // A cosine of 0 gets nowhere; this one is as good.
    for (const double theta_deg : specular_angles_deg()) mu.push_back(std::max(1e-9, std::cos(radians(theta_deg))));
    std::vector<brdf::OnceScattered> result;
    for (rt::OnceScatteredLayer& layer : rt::once_scattered(truncation, mu))
        result.push_back({layer.index_ratio, layer.optical_thickness, std::move(layer.scattering),
                          std::move(layer.down), std::move(layer.up)});
    return result;
}

// The order beyond which a scattering function varies by less than `tolerance` of its mean.
int effective_order(const optics::ExpansionCoefficients& x, double tolerance) {
    double rest = 0.0;
    int order = x.order();
    for (; order > 0; --order)
        if ((rest += std::abs(x.alpha1[order])) > tolerance) break;
    return order;
}

}  // namespace

std::vector<double> specular_angles_deg() {
    std::vector<double> angles;
    for (int i = 0; i <= 180; ++i) angles.push_back(0.5 * i);
    return angles;
}

bool is_sharp(const rt::Solver& solver, const rt::Problem& problem, double tolerance) {
    constexpr int smooth_order = 40;
    return !solver.is_statistical() && std::ranges::any_of(problem.layers, [&](const rt::Layer& layer) {
        return layer.optical_thickness > 0.0 && layer.single_scattering_albedo > 0.0 &&
               effective_order(layer.expansion, tolerance) > smooth_order;
    });
}

BodySolution solve_body(const rt::Solver& solver, const rt::Problem& problem, const rt::SolveOptions& options,
                        double tolerance) {
    if (!is_sharp(solver, problem, tolerance)) return {solver.reflection(problem, options), {}};
    const rt::Truncation truncation = rt::truncate(problem, options.streams);
    BodySolution result{solver.reflection(truncation.scaled, options), closed_forms(truncation)};
    rt::subtract_once_scattered(truncation, options.streams, result.reflection, options.cancel);
    rt::report_truncation(truncation, result.reflection.diagnostics);
    return result;
}

std::vector<brdf::OnceScattered> once_scattered_of(const rt::Solver& solver, const rt::Problem& problem, int streams,
                                                   double tolerance) {
    if (!is_sharp(solver, problem, tolerance)) return {};
    return closed_forms(rt::truncate(problem, streams));
}

}  // namespace patina::jobs
