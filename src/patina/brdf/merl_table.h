#pragma once
// An isotropic unpolarized BRDF in RGB on the grid of the MERL database (Matusik, Pfister, Brand & McMillan 2003).

#include <vector>

#include "patina/brdf/half_angle_table.h"

namespace patina::brdf {

class MerlTable {
  public:
    static constexpr int theta_h_count = 90, theta_d_count = 90, phi_d_count = 180;
    static constexpr std::size_t plane_size = std::size_t{theta_h_count} * theta_d_count * phi_d_count;

    std::vector<double> rgb;  // [red, green, blue][theta_h][theta_d][phi_d], 1/sr; negative where nothing was measured

    // The cell the angles fall into, as the database's own reader does: theta_h in steps that grow with its square,
    // phi_d folded to 0 .. pi by reciprocity.
    static std::size_t cell(const HalfAngles& angles);
    // The middle of a cell in those steps.
    static HalfAngles middle(int theta_h, int theta_d, int phi_d);

    Eigen::Vector3d evaluate(const HalfAngles& angles) const;
};

// f00 of the body, summed to RGB with weights (3 x W): rgb = weights times the values at the table's wavelengths.
// Colours outside the gamut are cut off at 0, as negative means "not measured"; `clamped` counts them where it is not
// null.
MerlTable to_merl(const MuellerTable& table, const Eigen::Matrix3Xd& rgb_weights, std::size_t* clamped = nullptr);

}  // namespace patina::brdf
