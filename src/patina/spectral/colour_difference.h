#pragma once
// Differences between two colours in CIE L*a*b*.

#include <Eigen/Dense>

namespace patina::spectral {

// Euclidean distance (CIE 1976).
double delta_e_76(const Eigen::Vector3d& lab_1, const Eigen::Vector3d& lab_2);

// CIEDE2000 with k_L = k_C = k_H = 1 (CIE 142-2001; hue means and branches as Sharma, Wu & Dalal 2005).
double delta_e_2000(const Eigen::Vector3d& lab_1, const Eigen::Vector3d& lab_2);

}  // namespace patina::spectral
