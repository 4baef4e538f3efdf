#pragma once
// Several kinds of particles in one layer, and the orientations of one birefringent kind.

#include <span>

#include "patina/optics/scattering/particle_ensemble.h"

namespace patina::optics {

struct MixtureComponent {
    ScatteringProperties properties;
    double number_density_per_um3;  // >= 0
};

// Bulk coefficients per length of path.
struct ScatteringMedium {
    double extinction_per_um = 0.0;
    double scattering_per_um = 0.0;
    double absorption_per_um = 0.0;
    ExpansionCoefficients expansion;

    double albedo() const { return extinction_per_um > 0.0 ? scattering_per_um / extinction_per_um : 0.0; }
    double asymmetry() const { return expansion.asymmetry(); }
};

// Sums cross sections per volume and averages the expansion with the weight of scattering. Independent kinds:
// interference between particles is inside the properties, not added here. Isotropic expansion if nothing scatters.
ScatteringMedium mix(std::span<const MixtureComponent> components);

// Averages per particle with weights that add up to 1: cross sections, volumes, and the expansion by scattering cross
// section.
ScatteringProperties average(const ScatteringProperties& first, double first_weight, const ScatteringProperties& second,
                             double second_weight);

// Randomly oriented uniaxial particles (rutile, calcite) as 2/3 of ordinary and 1/3 of extraordinary index, each
// isotropic: exact for particles small against the wavelength (Bohren & Huffman 1983, section 5.6), a usual
// approximation beyond.
inline ScatteringProperties average_birefringent(const ScatteringProperties& ordinary,
                                                 const ScatteringProperties& extraordinary) {
    return average(ordinary, 2.0 / 3.0, extraordinary, 1.0 / 3.0);
}

}  // namespace patina::optics
