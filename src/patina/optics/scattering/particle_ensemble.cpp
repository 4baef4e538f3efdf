#include "patina/optics/scattering/particle_ensemble.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/optics/scattering/expansion.h"
#include "patina/optics/scattering/mie.h"
#include "patina/optics/scattering/scattering_matrix.h"
#include "patina/optics/scattering/structure_factor.h"

namespace patina::optics {

namespace {

using Complex = std::complex<double>;

constexpr double max_size_parameter = 5000.0;

// A few seconds of one processor.
constexpr double max_operations = 4e10;

void validate_problem(Complex particle_index, Complex host_index, double wavelength_nm,
                      const ScatteringOptions& options, const SourceLocation& where) {
    const auto require = [&](bool legal, const std::string& problem, const char* why, const char* suggestion) {
        if (!legal) throw input_error(where, problem, why, suggestion);
    };
    const double n = particle_index.real(), k = particle_index.imag();
    require(std::isfinite(n) && n > 0.0 && n <= 100.0,
            fmt::format("the particle's refractive index has the real part {}", n), "it lies above 0 and up to 100",
            "use a positive number");
    require(std::isfinite(k) && k >= 0.0 && k <= 100.0, fmt::format("the particle's extinction coefficient k is {}", k),
            "k >= 0 absorbs; a negative one would amplify light", "use 0 or more");
    const double n_host = host_index.real(), k_host = host_index.imag();
    require(std::isfinite(n_host) && n_host >= 0.1 && n_host <= 100.0,
            fmt::format("the host's refractive index is {}", n_host), "it lies between 0.1 and 100",
            "use 1.5 for a binder");
    require(std::isfinite(k_host) && k_host >= 0.0 && k_host <= 0.5 * n_host,
            fmt::format("the host's extinction coefficient k is {}", k_host),
            "0 to half of its refractive index: light has to travel in it", "use 0 for a clear binder");
    require(std::isfinite(wavelength_nm) && wavelength_nm >= 1.0 && wavelength_nm <= 1e7,
            fmt::format("the wavelength is {} nm", wavelength_nm), "it lies between 1 nm and 1 cm",
            "use 380 to 780 for light");
    require(options.tolerance >= 1e-12 && options.tolerance <= 0.1,
            fmt::format("the tolerance is {}", options.tolerance), "it lies between 1e-12 and 0.1", "use 1e-5");
    require(options.packing_fraction >= 0.0 && options.packing_fraction <= max_packing_fraction,
            fmt::format("the particles fill the fraction {} of the volume", options.packing_fraction),
            "spheres pack at random up to 0.64", "use 0 to 0.64");
}

// Largest difference between the averages of two sums, in the measure of ScatteringOptions::tolerance.
double difference(const SphereSums& coarse, const SphereSums& fine, const math::Quadrature& cosines) {
    // Against the extinction, which may vanish or be negative in an absorbing host, and then against the scattering.
    const auto relative = [](double a, double b, double unit) { return unit > 0.0 ? std::abs(a - b) / unit : 0.0; };
    const double scale = fine.number / coarse.number;
    double error = std::max(relative(scale * coarse.extinction_um2, fine.extinction_um2,
                                     std::max(fine.extinction_um2, fine.scattering_um2)),
                            relative(scale * coarse.scattering_um2, fine.scattering_um2, fine.scattering_um2));

    const Eigen::Index half = cosines.size() / 2;
    Eigen::ArrayXd w(2 * half);
    for (Eigen::Index i = 0; i < half; ++i) w[i] = w[half + i] = cosines.weights[half + i];
    const double whole = (w * fine.elements.col(0)).sum();
    for (int element = 0; element < 4; ++element) {
        const double l1 = (w * (scale * coarse.elements.col(element) - fine.elements.col(element)).abs()).sum();
        error = std::max(error, l1 / whole);
    }
    return error;
}

// Does the user say where the sizes end?
bool has_cut_offs(const SizeDistribution& distribution) {
    return std::holds_alternative<Monodisperse>(distribution.shape) ||
           std::holds_alternative<PowerLaw>(distribution.shape) || std::holds_alternative<Histogram>(distribution.shape);
}

struct SizeAverage {
    SphereSums sums;
    int radii;
    double error;
};

// Doubles the number of intervals until the average changes by less than the tolerance: the finer of two estimates is
// far better than their difference where the rule converges exponentially, and about half as wrong where narrow
// resonances are still missed.
SizeAverage average_over_sizes(Complex relative_index, Complex wavenumber, const SizeDistribution& distribution,
                               const RadiusRange& range, const math::Quadrature& cosines,
                               const ScatteringOptions& options) {
    const auto sums_of = [&](const RadiusRule& rule) {
        return sum_spheres(relative_index, wavenumber, rule.radii_um, rule.weights, cosines);
    };
    constexpr int first_intervals = 32;
    int intervals = first_intervals;
    const double operations_per_radius = 4.0 * cosines.size() * cosines.size();
    const double affordable = std::min<double>(options.max_radii, max_operations / operations_per_radius);
    RadiusRule rule = radius_rule(distribution, range, intervals);
    SizeAverage average{sums_of(rule), static_cast<int>(rule.radii_um.size()), 0.0};
    if (std::holds_alternative<Monodisperse>(distribution.shape)) return average;

    do {
        intervals *= 2;
        rule = radius_rule(distribution, range, intervals, true);
        const SphereSums coarse = average.sums;
        // A weight carries the step; keep that of the first rule.
        for (double& weight : rule.weights) weight *= intervals / first_intervals;
        average.sums += sums_of(rule);
        average.radii += static_cast<int>(rule.radii_um.size());
        average.error = difference(coarse, average.sums, cosines);
    } while (average.error > options.tolerance && 2 * average.radii - 1 <= affordable);
    return average;
}

}  // namespace

ScatteringProperties scatter(Complex particle_index, Complex host_index, double wavelength_nm,
                             const SizeDistribution& distribution, const ScatteringOptions& options,
                             const SourceLocation& where) {
    validate_problem(particle_index, host_index, wavelength_nm, options, where);
    validate(distribution, where);
    const Complex relative_index =
        host_index.imag() == 0.0 ? particle_index / host_index.real() : particle_index / host_index;
    const Complex complex_wavenumber = 2.0 * pi * host_index / (1e-3 * wavelength_nm);
    const double wavenumber = complex_wavenumber.real();

    // Find the sizes that matter, and the angles that the largest of them needs.
    RadiusRange range = relevant_range(distribution, wavenumber, options.tolerance);
    if (wavenumber * range.max_um > max_size_parameter)
        throw input_error(where, fmt::format("the size distribution reaches to radii of {:.3g} um", range.max_um),
                          fmt::format("Lorenz-Mie sums end at a circumference of {} wavelengths", max_size_parameter),
                          fmt::format("use radii below {:.3g} um, a narrower distribution or a looser tolerance",
                                      max_size_parameter / wavenumber));
    // A number that hardly falls towards small particles (Rosin-Rammler by volume, of a spread a little above 3) is cut
    // where no particle is left that is made of atoms.
    constexpr double smallest_size_parameter = 1e-19;
    if (!has_cut_offs(distribution) && wavenumber * range.max_um > smallest_size_parameter)
        range.min_um = std::max(range.min_um, smallest_size_parameter / wavenumber);
    if (wavenumber * range.min_um < 1e-20)
        throw input_error(where, fmt::format("the size distribution reaches to radii of {:.3g} um", range.min_um),
                          "their circumference is below 1e-20 wavelengths",
                          "use a narrower or coarser size distribution");
    if (complex_wavenumber.imag() * range.max_um > MieSphere::max_host_absorption)
        throw input_error(
            where, fmt::format("the size distribution reaches to radii of {:.3g} um", range.max_um),
            fmt::format("the host absorbs all light on the way around them (k = {:g})", host_index.imag()),
            fmt::format("use radii below {:.3g} um or a weaker absorption",
                        MieSphere::max_host_absorption / complex_wavenumber.imag()));
    const math::Quadrature cosines = math::gauss_legendre(matrix_nodes(wavenumber * range.max_um));
    const SizeAverage average =
        average_over_sizes(relative_index, complex_wavenumber, distribution, range, cosines, options);

    ScatteringProperties properties;
    const SphereSums& sums = average.sums;
    properties.scattering_um2 = sums.scattering_um2 / sums.number;
    properties.absorption_um2 = sums.absorption_um2 / sums.number;
    properties.mean_volume_um3 = 4.0 / 3.0 * pi * sums.radius3_um3 / sums.number;
    properties.effective_radius_um = sums.radius3_um3 / sums.radius2_um2;
    properties.radii = average.radii;
    properties.quadrature_error = average.error;

    // A particle of the host's own index scatters nothing; call its direction isotropic.
    if (!(sums.scattering_um2 > 0.0)) {
        properties.extinction_um2 = properties.absorption_um2;
        properties.expansion = {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
        return properties;
    }
    ScatteringMatrix matrix = scattering_matrix(sums, cosines);
    if (options.packing_fraction > 0.0) {
        const double diameter = 2.0 * std::cbrt(sums.radius3_um3 / sums.number);
        properties.scattering_um2 *= apply_structure_factor(matrix, options.packing_fraction, wavenumber, diameter);
    }
    properties.extinction_um2 = properties.scattering_um2 + properties.absorption_um2;
    properties.expansion = expand(matrix, options.tolerance);
    return properties;
}

}  // namespace patina::optics
