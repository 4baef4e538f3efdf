#pragma once
// The Mueller BRDF table as an HDF5 file: layout and conventions in docs/formats/mueller_table_hdf5.md.

#include <filesystem>

#include "patina/brdf/mueller_table.h"

namespace patina::io {

// Version 2 adds once scattered light in closed form; a table without it is written as version 1.
inline constexpr int mueller_table_format_version = 2;

struct TableWriteOptions {
    bool single_precision = false;  // /body as float32: half the size, 6e-8 relative rounding
    int compression_level = 1;      // gzip 0 .. 9 after byte shuffling
};

// Writes the table whole or not at all. Throws Error(input) for a table that is not valid, Error(runtime) when it
// cannot be written.
void write_table_hdf5(const brdf::MuellerTable& table, const std::filesystem::path& path,
                      const TableWriteOptions& options = {});

// Throws Error(input) naming the file and the dataset for anything but a valid table of this or an older version.
brdf::MuellerTable read_table_hdf5(const std::filesystem::path& path);

}  // namespace patina::io
