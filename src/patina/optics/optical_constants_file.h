#pragma once
// Reading optical constants: pages of the refractiveindex.info database (YAML) and CSV.
//
// YAML: a list DATA of blocks of `type` "tabulated nk", "tabulated n", "tabulated k" (with `data`, one row per
// wavelength in um) or "formula 1" ... "formula 9" (with `wavelength_range` in um and `coefficients`); n and k may
// stand in different blocks. REFERENCES and COMMENTS are kept, other keys are ignored. CSV: a header line naming
// `wavelength_um` or `wavelength_nm`, `n`, and optionally `k`, whose cells may be empty;
// '#' comments, of which "publication: ..." names the source.
// Tables are linear between rows. The range of a material is where both its n and, if given, its k have data.

#include <filesystem>
#include <string>
#include <string_view>

#include "patina/optics/refractive_index.h"

namespace patina::optics {

struct OpticalConstantsFile {
    OpticalConstants constants;
    std::string comments;
};

// `file` names the text in errors, which are Error(input) with file:line:column: not that format, n <= 0, k < 0, not
// finite, wavelengths not ascending, coefficients missing, a formula without an index in its own range, no n at all.
OpticalConstantsFile parse_optical_constants_yaml(std::string_view text, const std::string& file,
                                                  const std::string& name);
OpticalConstantsFile parse_optical_constants_csv(std::string_view text, const std::string& file,
                                                 const std::string& name);

// By the extension: .yml, .yaml or .csv. The material is named after the file.
OpticalConstantsFile read_optical_constants(const std::filesystem::path& path);

}  // namespace patina::optics
