#pragma once
// Optical properties of one kind of particle in a host: the size average that radiative transfer needs.

#include <complex>

#include "patina/optics/scattering/expansion_coefficients.h"
#include "patina/optics/scattering/size_distribution.h"

namespace patina::optics {

// Averages over the particles of one kind, per particle.
struct ScatteringProperties {
    double extinction_um2 = 0.0;
    double scattering_um2 = 0.0;
    double absorption_um2 = 0.0;       // negative where a particle absorbs less than the host it replaces
    double mean_volume_um3 = 0.0;      // a volume fraction f means f / mean_volume particles per um^3
    double effective_radius_um = 0.0;  // <r^3>/<r^2>
    ExpansionCoefficients expansion;   // order >= 2
    int radii = 0;                     // Mie spheres computed
    double quadrature_error = 0.0;     // estimated error of the average over sizes, in the measure of `tolerance`

    double albedo() const { return extinction_um2 > 0.0 ? scattering_um2 / extinction_um2 : 0.0; }
    double asymmetry() const { return expansion.asymmetry(); }
};

struct ScatteringOptions {
    // Wanted error of the size average: relative for the cross sections; for F, (1/2) int |error of each element| dcos,
    // which bounds |error of each coefficient| / (2l+1). Coefficients below it are left out at the high end. 1e-12 ..
    // 0.1.
    double tolerance = 1e-5;
    // Volume fraction of all particles, whose interference is then taken into account by the Percus-Yevick structure
    // factor; 0: independent particles. A polydisperse system is treated as one of equal spheres of the same number
    // density and volume fraction, d = 2 <r^3>^(1/3).
    double packing_fraction = 0.0;
    // The most radii spent. Narrow resonances of transparent particles may need more at strict tolerances, and large
    // spheres cost too much for so many (the sums stop at about 4e10 operations); quadrature_error tells what was
    // reached.
    int max_radii = 16385;
};

// Homogeneous spheres of one material and a distribution of sizes in a host of index n + i k. Indices at the given
// vacuum wavelength. The size average refines a nested rule until it is stable. Cost: one to three microseconds a
// radius for pigments. In an absorbing host the cross sections are those of MieSphere::in_absorbing_host: what the
// particles add to the host's own 4 pi k / lambda, the host they replace already taken off. Throws Error(input) at
// `where` for indices, wavelengths, distributions or packing fractions that are not physical, for distributions that
// reach beyond the size parameter 5000, where expansions become useless, and for hosts that absorb within a particle's
// radius (k'' r > MieSphere::max_host_absorption).
ScatteringProperties scatter(std::complex<double> particle_index, std::complex<double> host_index, double wavelength_nm,
                             const SizeDistribution& distribution, const ScatteringOptions& options = {},
                             const SourceLocation& where = {});

}  // namespace patina::optics
