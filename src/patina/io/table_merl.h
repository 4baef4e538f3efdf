#pragma once
// Files of the MERL BRDF database, .binary: three int32 (90, 90, 180), then float64 planes of red, green and blue,
// scaled by 1500, 1500/1.15 and 1500/1.66 (Matusik et al. 2003).

#include <filesystem>

#include "patina/brdf/merl_table.h"

namespace patina::io {

void write_table_merl(const brdf::MerlTable& table, const std::filesystem::path& path);

// Throws Error(input) naming the file for another size of grid, a truncated file or numbers that are not finite.
brdf::MerlTable read_table_merl(const std::filesystem::path& path);

}  // namespace patina::io
