#pragma once
// Particles whose scattering comes from elsewhere: T-matrix programs, discrete dipoles, measurements.

#include <string>
#include <vector>

#include "patina/optics/refractive_index.h"
#include "patina/optics/scattering/particle_ensemble.h"

namespace patina::optics {

// Averages over orientations, shapes and sizes, per particle, in the host in question. Both lists ascend in wavelength;
// a single entry of wavelength 0 holds at every wavelength.
struct ExternalParticles {
    struct Law {
        double wavelength_nm;
        ExpansionCoefficients expansion;
    };
    struct CrossSections {
        double wavelength_nm;
        double extinction_um2, scattering_um2;
    };
    std::string name;
    double volume_um3 = 0.0;
    std::vector<Law> laws;
    std::vector<CrossSections> cross_sections;
};

// Properties at a vacuum wavelength, cross sections and expansion coefficients being linear between the given ones.
// Throws Error(input) outside them unless `extrapolation` is hold. The effective radius is that of the sphere of the
// same volume.
ScatteringProperties scatter(const ExternalParticles& particles, double wavelength_nm, Extrapolation extrapolation);

// True when `wavelength_nm` lies within the data.
bool covers(const ExternalParticles& particles, double wavelength_nm);

// Takes the interference of densely packed particles into account, each like a hard sphere of its volume in a host of
// the (real) refractive index; see structure_factor.h.
ScatteringProperties pack(const ScatteringProperties& particles, double packing_fraction, double host_index,
                          double wavelength_nm);

}  // namespace patina::optics
