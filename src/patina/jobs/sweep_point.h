#pragma once
// One point of a sweep: its quantities, and its file.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "patina/coating/paint_metrics.h"

namespace patina::jobs {

// A quantity a sweep reports.
struct SweepQuantity {
    std::string name;  // with its unit, as in CSV and HDF5
    std::string units, long_name;
};

// `optical`: the layer is given in optical terms, and lengths are optical thicknesses.
std::vector<SweepQuantity> sweep_quantities(bool optical);

struct SweepPoint {
    std::vector<double> quantities;                        // as sweep_quantities; NaN where not defined
    std::vector<double> wavelengths_nm, reflectance_45_0;  // over the own base
    bool converged = true;
};
SweepPoint sweep_point(const coating::PaintMetrics& metrics);

// What the result of a point depends on, as 16 hexadecimal digits: the recipe's text, the optical constants it names,
// the options and the version of the program.
std::string sweep_point_key(const coating::Recipe& recipe, const coating::PaintOptions& options);

// Written whole or not at all; nothing when the file is missing, damaged or not of this key and these quantities.
void write_sweep_point(const std::filesystem::path& path, const std::string& key,
                       const std::vector<SweepQuantity>& quantities, const std::vector<std::string>& settings,
                       const SweepPoint& point);
std::optional<SweepPoint> read_sweep_point(const std::filesystem::path& path, const std::string& key,
                                           const std::vector<SweepQuantity>& quantities);

}  // namespace patina::jobs
