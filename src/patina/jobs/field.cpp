#include "patina/jobs/field.h"

#include <fmt/format.h>

#include "patina/coating/optical_problem.h"
#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/jobs/converged_field.h"

namespace patina::jobs {

namespace {

constexpr double scattering_tolerance = 1e-6;

void check_angles(const std::vector<double>& angles_deg, double limit, const char* name) {
    if (angles_deg.empty()) throw Error(ErrorKind::usage, fmt::format("{} needs at least one angle", name));
    for (const double angle : angles_deg)
        if (!(std::abs(angle) <= limit) || (limit == 90.0 && angle < 0.0))
            throw Error(ErrorKind::usage, fmt::format("{}: {:g} degrees (it must be between {} and {:g})", name, angle,
                                                      limit == 90.0 ? "0" : "-360", limit));
}

double cosine(double angle_deg) {
    return angle_deg == 90.0 ? 0.0 : std::cos(radians(angle_deg));
}

double total_optical_thickness(const rt::Problem& problem) {
    double total = 0.0;
    for (const rt::Layer& layer : problem.layers) total += layer.optical_thickness;
    return total;
}

rt::FieldRequest make_request(const FieldJob& job, double optical_thickness) {
    rt::FieldRequest request;
    request.mu_i = cosine(job.theta_i_deg);
    request.incident = job.incident;
    request.optical_depths = job.optical_depths;
    if (request.optical_depths.empty()) {
        request.optical_depths = {0.0};
        if (std::isfinite(optical_thickness) && optical_thickness > 0.0)
            request.optical_depths.push_back(optical_thickness);
    }
    for (const double depth : request.optical_depths)
        if (!(depth >= 0.0 && depth <= optical_thickness * (1 + 1e-12)))
            throw Error(ErrorKind::usage,
                        fmt::format("--tau {:g} lies outside the coating (its optical thickness is {:g})", depth,
                                    optical_thickness));
    std::sort(request.optical_depths.begin(), request.optical_depths.end());
    for (const double theta : job.theta_o_deg) request.mu_o.push_back(cosine(theta));
    for (const double phi : job.phi_deg) request.phi.push_back(radians(phi));
    return request;
}

void check_incidence(const FieldJob& job) {
    if (!(job.theta_i_deg >= 0.0 && job.theta_i_deg < 90.0))
        throw Error(ErrorKind::usage,
                    fmt::format("--theta-i-deg {:g}: it must be at least 0 and below 90", job.theta_i_deg));
    const optics::Stokes& s = job.incident;
    if (!s.allFinite() || s[0] <= 0.0 || s.tail<3>().norm() > s[0] * (1 + 1e-12))
        throw Error(
            ErrorKind::usage,
            fmt::format("--stokes {},{},{},{} is no light (I must be positive and at least sqrt(Q^2 + U^2 + V^2))",
                        s[0], s[1], s[2], s[3]));
    check_angles(job.theta_o_deg, 90.0, "--theta-o-deg");
    check_angles(job.phi_deg, 360.0, "--phi-deg");
}

void check_streams(int streams) {
    if (streams != 0 && (streams < 2 || streams > 512))
        throw Error(ErrorKind::usage, fmt::format("--streams {}: 2 to 512 make sense", streams));
}

// A law of scattering that matter cannot have makes light without bounds.
void expect_finite(const std::vector<FieldValue>& radiance) {
    for (const FieldValue& value : radiance)
        if (!value.stokes.allFinite() || (value.standard_error && !value.standard_error->allFinite()))
            throw Error(
                ErrorKind::check,
                fmt::format("the radiance at tau {:g}, {:g} degrees is not a finite number; check the expansion "
                            "coefficients, or try another solver",
                            value.optical_depth, value.theta_deg));
}

}  // namespace

FieldResult field(const coating::Recipe& recipe, const FieldJob& job, const JobControl& control) {
    check_incidence(job);
    check_streams(job.streams);
    if (!job.wavelength_nm && !recipe.is_wavelength_independent())
        throw Error(ErrorKind::usage, "this recipe depends on wavelength: give --wavelength-nm");

    const coating::OpticalProblem optical =
        coating::optical_problem(recipe, job.wavelength_nm.value_or(550.0), scattering_tolerance);
    const rt::Problem& problem = optical.problem;
    rt::validate(problem);
    const rt::Solver& solver = rt::solver_named(job.solver);
    if (const std::string reason = solver.unsupported(problem); !reason.empty())
        throw Error(ErrorKind::input, fmt::format("solver \"{}\" cannot do this recipe ({})", solver.name(), reason));

    FieldResult result;
    result.notes = optical.notes;
    result.optical_thickness = total_optical_thickness(problem);
    const rt::FieldRequest request = make_request(job, result.optical_thickness);
    rt::SolveOptions options;
    options.scalar = job.scalar;
    options.samples = job.samples;
    options.seed = job.seed;
    options.cancel = control.cancel;
    options.progress = [&](double part) { control.report({"solving", 0, 1, "", part}); };
    options.streams = job.streams;
    const rt::Field computed = job.streams != 0 ? field_of_views(solver, problem, request, options)
                                                : converged_field(solver, problem, request, options);
    control.report({"solving", 1, 1, ""});
    result.diagnostics = computed.diagnostics;
    const std::vector<std::string>& said = result.diagnostics.notes;
    result.notes.insert(result.notes.end(), said.begin(), said.end());

    // List the depths in order, without the directions that only exist inside when nothing was asked for inside.
    for (size_t d = 0; d < request.optical_depths.size(); ++d)
        for (const bool upward : {true, false}) {
            if (job.optical_depths.empty() && upward != (d == 0)) continue;
            const auto& hemisphere = upward ? computed.upward[d] : computed.downward[d];
            const auto& errors = upward ? computed.upward_error : computed.downward_error;
            for (size_t o = 0; o < job.theta_o_deg.size(); ++o)
                for (size_t p = 0; p < job.phi_deg.size(); ++p)
                    result.radiance.push_back({request.optical_depths[d], upward, job.theta_o_deg[o], job.phi_deg[p],
                                               hemisphere[o][p],
                                               errors.empty() ? std::nullopt : std::optional(errors[d][o][p])});
        }
    result.specular_surface = rt::specular_surface(problem, request.mu_i);
    result.specular_coherent = rt::specular_coherent(problem, request.mu_i);
    expect_finite(result.radiance);
    return result;
}

}  // namespace patina::jobs
