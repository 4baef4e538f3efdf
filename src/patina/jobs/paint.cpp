#include "patina/jobs/paint.h"

#include <cmath>

#include <fmt/format.h>

#include "patina/coating/paint_metrics_colour.h"
#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/jobs/solve.h"
#include "patina/optics/fresnel.h"
#include "patina/spectral/colour_difference.h"

namespace patina::jobs {

namespace {

// Reflectance factor pi f(I <- I) of the body in the plane of incidence; `theta_o_deg` is negative on the side of the
// light.
std::vector<double> in_plane(const brdf::MuellerTable& table, double theta_i_deg, double theta_o_deg) {
    std::vector<double> factors;
    const double phi = theta_o_deg >= 0.0 ? 0.0 : pi;
    for (const double wavelength : table.wavelengths_nm)
        factors.push_back(
            pi * table.evaluate(wavelength, std::cos(radians(theta_o_deg)), std::cos(radians(theta_i_deg)), phi)(0, 0));
    return factors;
}

void check(const PaintRequest& request) {
    const auto inside = [](double value, double low, double high) { return value > low && value <= high; };
    const coating::PaintOptions& options = request.options;
    if (!inside(options.white_reflectance, 0.0, 1.0))
        throw Error(ErrorKind::usage,
                    fmt::format("a white card of reflectance {:g} (above 0, at most 1)", options.white_reflectance));
    if (!inside(options.wanted_contrast_ratio, 0.0, 1.0 - 1e-6))
        throw Error(ErrorKind::usage,
                    fmt::format("a contrast ratio of {:g} (above 0, below 1)", options.wanted_contrast_ratio));
    if (options.stack.streams != 0 && (options.stack.streams < 2 || options.stack.streams > 512))
        throw Error(ErrorKind::usage, fmt::format("--streams {}: 2 to 512 make sense", options.stack.streams));
    const std::vector<double>& wavelengths = options.stack.wavelengths_nm;
    for (std::size_t i = 0; i < wavelengths.size(); ++i) {
        if (!(wavelengths[i] >= 100.0 && wavelengths[i] <= 1e6))
            throw Error(ErrorKind::usage,
                        fmt::format("a wavelength of {:g} nm (100 nm to 1 mm make sense)", wavelengths[i]));
        if (i > 0 && wavelengths[i] <= wavelengths[i - 1])
            throw Error(ErrorKind::usage, fmt::format("wavelengths must ascend ({:g} nm follows {:g} nm)",
                                                      wavelengths[i], wavelengths[i - 1]));
    }
}

}  // namespace

std::vector<double> paint_wavelengths(const coating::Recipe& recipe, const std::vector<double>& wanted_nm) {
    if (!wanted_nm.empty()) return wanted_nm;
    if (recipe.is_wavelength_independent()) return {550.0};
    std::vector<double> visible;
    for (int wavelength = 400; wavelength <= 700; wavelength += 10) visible.push_back(wavelength);
    return visible;
}

std::vector<AspecularColour> aspecular_colours(const brdf::MuellerTable& table) {
    constexpr double theta_i_deg = 45.0;
    std::vector<AspecularColour> colours;
    for (const double aspecular_deg : {15.0, 25.0, 45.0, 75.0, 110.0}) {
        AspecularColour colour{aspecular_deg, in_plane(table, theta_i_deg, theta_i_deg - aspecular_deg), {}};
        colour.lab = coating::lab(table.wavelengths_nm, colour.reflectance, coating::laboratory_viewing);
        colours.push_back(std::move(colour));
    }
    return colours;
}

std::vector<Gloss> gloss(const brdf::MuellerTable& table) {
    // ISO 2813 gives the black glass its index at the helium d line.
    constexpr double black_glass_index = 1.567, wavelength_nm = 587.6;
    std::vector<Gloss> result;
    for (const double theta_deg : {20.0, 60.0, 85.0}) {
        const double mu = std::cos(radians(theta_deg));
        const double standard = optics::fresnel_reflection(mu, 1.0, black_glass_index)(0, 0);
        result.push_back({theta_deg, 100.0 * table.specular(wavelength_nm, mu)(0, 0) / standard});
    }
    return result;
}

Eigen::Vector3d lab_45_0(const brdf::MuellerTable& table) {
    return coating::lab(table.wavelengths_nm, in_plane(table, 45.0, 0.0), coating::laboratory_viewing);
}

PaintReport paint(const coating::Recipe& recipe, const PaintRequest& request, const JobControl& control) {
    check(request);
    coating::PaintOptions options = request.options;
    options.stack.wavelengths_nm = paint_wavelengths(recipe, options.stack.wavelengths_nm);
    PaintReport report;
    report.metrics = coating::paint_metrics(recipe, options, control);

    if (request.angular) {
        SolveRequest whole;
        whole.wavelengths_nm = options.stack.wavelengths_nm;
        // Where forward peaks are truncated, directions want more streams than reflectances, and a bound.
        whole.streams = report.metrics.streams_are_exact ? report.metrics.streams : options.stack.streams;
        whole.tolerance = options.stack.tolerance;
        whole.solver = options.stack.solver;
        whole.command = request.command;
        const SolveResult solved = solve(recipe, whole, control);
        if (solved.interrupted) throw Error(ErrorKind::interrupted, "stopped");
        report.metrics.converged = report.metrics.converged && solved.converged;
        report.aspecular = aspecular_colours(solved.table);
        report.gloss = gloss(solved.table);
    }

    if (request.against) {
        coating::StackOptions stack = options.stack;
        if (stack.streams == 0) stack.streams = report.metrics.streams;
        report.tinting_strength = coating::tinting_strength(recipe, *request.against, stack, control);
    }

    if (request.target_lab) {
        report.target_lab = request.target_lab;
        report.delta_e_2000 = spectral::delta_e_2000(
            *request.target_lab,
            coating::lab(report.metrics.wavelengths_nm, report.metrics.own.r45_0, coating::laboratory_viewing));
    }
    return report;
}

}  // namespace patina::jobs
