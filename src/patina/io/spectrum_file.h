#pragma once
// Sampled spectra as text: .spd (Mitsuba, pbrt) and .csv, two numbers a line.

#include <filesystem>

#include "patina/core/properties.h"

namespace patina::io {

// Wavelength in nm and value a line, separated by white space, a comma or a semicolon; '#' starts a comment; one header
// line of words is allowed. Wavelengths must ascend. Throws Error(input) with file and line.
SpectrumSpec read_spectrum_file(const std::filesystem::path& path);

// Throws Error(input) at `where` unless wavelengths are positive and ascend and there is one value for each.
void expect_sampled(const SpectrumSpec& spectrum, const SourceLocation& where);

}  // namespace patina::io
