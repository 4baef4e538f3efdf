#pragma once
// Mitsuba 3's `measured_polarized` BRDF files, .pbsdf: layout in docs/formats/exports.md.

#include <filesystem>

#include "patina/brdf/half_angle_table.h"

namespace patina::io {

// Stock Mitsuba 3 reads exactly five wavelengths; any number of whole nanometres can be written. Throws Error(input)
// for a table that is not valid, Error(runtime) when it cannot be written.
void write_table_pbsdf(const brdf::HalfAngleTable& table, const std::filesystem::path& path);

// Throws Error(input) naming the file and the field for anything else than a valid file; axes of shape (0, N), as in
// Mitsuba's own low-resolution test asset, are refused.
brdf::HalfAngleTable read_table_pbsdf(const std::filesystem::path& path);

}  // namespace patina::io
