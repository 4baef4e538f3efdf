#pragma once
// A scattering medium at the wavelengths of a regular grid.

#include <string>
#include <vector>

#include "patina/optics/scattering/mixture.h"

namespace patina::optics {

struct SpectralMedium {
    double first_nm = 0.0, step_nm = 1.0;
    std::vector<ScatteringMedium> media;  // [wavelength], at least one; one alone counts for all wavelengths
    std::vector<double> host_index;       // [wavelength], of the matter around the particles
    std::vector<std::string> notes, citations;
};

}  // namespace patina::optics
