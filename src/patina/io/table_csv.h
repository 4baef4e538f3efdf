#pragma once
// The body BRDF as a long CSV table, one direction pair and wavelength a line: for spreadsheets and plotting programs.

#include <filesystem>
#include <vector>

#include "patina/brdf/mueller_table.h"

namespace patina::io {

struct CsvGrid {
    std::vector<double> wavelengths_nm;  // empty: the table's own
    std::vector<double> theta_i_deg = {0, 10, 20, 30, 40, 50, 60, 70, 80};
    std::vector<double> theta_o_deg = {0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75, 80, 85};
    std::vector<double> phi_deg = {0, 15, 30, 45, 60, 75, 90, 105, 120, 135, 150, 165, 180};
};

// Header wavelength_nm,theta_i_deg,theta_o_deg,phi_deg,m00,m01,..,m33; elements in 1/sr in the table's own conventions
// (docs/formats/exports.md), nine significant digits. Throws Error(input) for angles outside 0 .. 90 deg.
void write_table_csv(const brdf::MuellerTable& table, const std::filesystem::path& path, const CsvGrid& grid = {});

}  // namespace patina::io
