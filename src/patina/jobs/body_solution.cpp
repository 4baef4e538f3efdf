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

bool is_sharp(const rt::Truncation& truncation, double tolerance) {
    return std::ranges::any_of(truncation.forward, [&](double f) { return f > 0.1 * tolerance; });
}

}  // namespace

std::vector<double> specular_angles_deg() {
    std::vector<double> angles;
    for (int i = 0; i <= 180; ++i) angles.push_back(0.5 * i);
    return angles;
}

bool is_sharp(const rt::Solver& solver, const rt::Problem& problem, int streams, double tolerance) {
    return !solver.is_statistical() && is_sharp(rt::truncate(problem, streams), tolerance);
}

BodySolution solve_body(const rt::Solver& solver, const rt::Problem& problem, const rt::SolveOptions& options,
                        double tolerance) {
    if (solver.is_statistical()) return {solver.reflection(problem, options), {}};
    const rt::Truncation truncation = rt::truncate(problem, options.streams);
    if (!is_sharp(truncation, tolerance)) return {solver.reflection(problem, options), {}};
    BodySolution result{solver.reflection(truncation.scaled, options), closed_forms(truncation)};
    rt::subtract_once_scattered(truncation, options.streams, result.reflection);
    rt::report_truncation(truncation, result.reflection.diagnostics);
    return result;
}

std::vector<brdf::OnceScattered> once_scattered_of(const rt::Solver& solver, const rt::Problem& problem, int streams,
                                                   double tolerance) {
    if (solver.is_statistical()) return {};
    const rt::Truncation truncation = rt::truncate(problem, streams);
    return is_sharp(truncation, tolerance) ? closed_forms(truncation) : std::vector<brdf::OnceScattered>{};
}

}  // namespace patina::jobs
