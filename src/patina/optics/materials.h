#pragma once
// The built-in optical constants, and finding the material a user names. The data stand in data/materials and are
// compiled in; library.yml there lists them.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "patina/core/error.h"
#include "patina/optics/refractive_index.h"

namespace patina::optics {

struct MaterialInfo {
    std::string name;
    std::vector<std::string> aliases;
    std::string description;
    std::string citation;
    std::string comments;
    double wavelength_min_nm, wavelength_max_nm;
    bool k_known;
};

// All built-in materials, in the order of the library.
const std::vector<MaterialInfo>& builtin_materials();

// Those whose name, alias, description, citation or comments contain `words`, upper and lower case alike.
std::vector<MaterialInfo> search_builtin_materials(std::string_view words);

// By name or alias, upper and lower case alike where that is not ambiguous. Throws Error(input) at `where` for an
// unknown name, and for an alias of several materials, listing them.
const OpticalConstants& builtin_material(std::string_view name, const SourceLocation& where = {});

// What a recipe may write: a built-in name, or a file (.yml, .yaml, .csv) relative to `base_folder`.
OpticalConstants material(std::string_view spec, const std::filesystem::path& base_folder = {},
                          const SourceLocation& where = {});

}  // namespace patina::optics
