#pragma once
// Where a recipe's own files are looked for, and the materials it names.

#include <filesystem>
#include <string>
#include <string_view>

#include "patina/coating/table_reader.h"
#include "patina/optics/refractive_index.h"

namespace patina::coating {

struct Context {
    std::string file;  // of the recipe, in messages
    std::filesystem::path folder;
    int depth = 0;  // how many recipes lie on this one
};

// A material given by name, by file, or as { n, k }; a missing key is an Error(input).
optics::OpticalConstants read_material(const TableReader& reader, std::string_view key, const Context& context);

}  // namespace patina::coating
