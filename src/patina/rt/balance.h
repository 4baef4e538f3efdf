#pragma once
// Reciprocal balancing of a boundary's flux on the nodes of a quadrature.

#include <vector>

#include <Eigen/Dense>

#include "patina/rt/nodes.h"

namespace patina::rt {

// Factors c, one a ray, with c_i sum_o b(o,i) c_o = target_i, the sum over the quadrature rays (Sinkhorn & Knopp 1967,
// Pacific J. Math. 21, 343). `b` holds the flux from ray i to ray o; view and beam rays follow from the factors of the
// others. A ray that no light reaches or leaves keeps the factor 1.
Eigen::VectorXd balance(const Eigen::MatrixXd& b, const Eigen::VectorXd& target, const std::vector<Role>& roles);

// Largest |c^2 - 1| on quadrature rays steeper than 60 degrees.
double largest_correction(const Eigen::VectorXd& factors, const Medium& medium);

}  // namespace patina::rt
