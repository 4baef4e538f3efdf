#pragma once
// How two tables, pictures or recipes differ.

#include <array>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "patina/brdf/mueller_table.h"
#include "patina/jobs/paint.h"

namespace patina::jobs {

struct Difference {
    double root_mean_square = 0.0, largest = 0.0;  // of |b - a|
};

// At one wavelength of A, over the nodes of A for both directions (up to 80 degrees) and azimuths every 15 degrees.
struct TableDifference {
    double wavelength_nm = 0.0;
    double mean_f00 = 0.0;                             // of A, 1/sr, the scale of the first
    Difference f00;                                    // body BRDF, element I <- I, 1/sr
    std::array<std::array<Difference, 4>, 4> mueller;  // elements divided by the own f00 ([0][0] is 0)
    Difference dolp;                                   // degree of linear polarization of unpolarized light
    Difference albedo;  // directional-hemispherical reflectance, over angles of incidence
};

// Throws Error(input) when the tables have no wavelength in common range.
std::vector<TableDifference> compare_tables(const brdf::MuellerTable& a, const brdf::MuellerTable& b);

struct ColourDifference {
    std::string geometry;  // "45:0", "d:8 excluded", "d:8 included"
    std::string illuminant;
    int observer_deg = 0;
    Eigen::Vector3d lab_a, lab_b;
    double delta_e_2000 = 0.0;
};

// Over the recipes' own bases.
std::vector<ColourDifference> compare_colours(const coating::PaintMetrics& a, const coating::PaintMetrics& b);

}  // namespace patina::jobs
