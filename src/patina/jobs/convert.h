#pragma once
// BRDF tables from one file format to another, and what that costs in accuracy.

#include <filesystem>
#include <string>
#include <vector>

namespace patina::jobs {

struct ConvertRequest {
    std::filesystem::path input, output;      // formats by extension: .h5, .pbsdf; output also .binary (MERL), .csv
    std::vector<double> wavelengths_nm;       // of the output; empty: the format's default (docs/formats/exports.md)
    int phi_d = 0, theta_d = 0, theta_h = 0;  // grid of a .pbsdf; 0: its default
};

// How the output, read back and evaluated as its readers do, differs from the input's BRDF at random directions.
struct ConversionError {
    std::string of;  // what is compared: "Mueller elements", "linear sRGB"
    int directions = 0;
    double largest = 0.0;  // absolute, 1/sr
    double rms = 0.0;
    double scale = 0.0;  // largest f00 (or colour) at these directions
};

struct ConvertResult {
    std::vector<std::string> notes;
    std::vector<double> wavelengths_nm;
    ConversionError error;
};

// Throws Error(usage) for formats or settings that do not go together, Error(input) for a bad input file,
// Error(runtime) when the output cannot be written.
ConvertResult convert(const ConvertRequest& request);

}  // namespace patina::jobs
