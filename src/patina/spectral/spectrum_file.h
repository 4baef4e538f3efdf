#pragma once
// Spectra from text files: .spd (wavelength in nm and value on each line, '#' comments; Mitsuba, pbrt) and CSV.
//
// CSV may have a header line: `wavelength_nm` or `wavelength_um`, then any name. Without one wavelengths are in nm.

#include <filesystem>
#include <string>
#include <string_view>

#include "patina/spectral/spectrum.h"

namespace patina::spectral {

// Throws Error(input) with the place in `file` for a row that is not two finite numbers, a wavelength that is not
// positive or does not ascend, and for no rows at all. Values may have any sign; what they may be is for their use to
// say.
Spectrum parse_spectrum(std::string_view text, const std::string& file, Outside outside);

Spectrum read_spectrum(const std::filesystem::path& path, Outside outside);

}  // namespace patina::spectral
