#pragma once
// Files of scattering laws and cross sections (docs/formats/scattering_csv.md). Each may carry wavelengths.

#include <filesystem>

#include "patina/optics/scattering/external_particles.h"

namespace patina::coating {

using Laws = std::vector<optics::ExternalParticles::Law>;

// Coefficients: l,alpha1,alpha2,alpha3,alpha4,beta1,beta2, a row an order from l = 0 on; in blocks of ascending
// wavelength after a first column wavelength_nm. Throws Error(input) with the line for anything else.
Laws read_expansion_csv(const std::filesystem::path& path);

// Matrices against angle: angle_deg,F11,F12,F22,F33,F34,F44 from 0 to 180 degrees in any scale; blocks as above.
Laws read_matrix_csv(const std::filesystem::path& path);

// wavelength_nm,extinction_um2,scattering_um2, per particle.
std::vector<optics::ExternalParticles::CrossSections> read_cross_sections_csv(const std::filesystem::path& path);

// The law of a file that has no wavelengths. Throws Error(input) when it has.
optics::ExpansionCoefficients only_law(Laws laws, const std::filesystem::path& path);

}  // namespace patina::coating
