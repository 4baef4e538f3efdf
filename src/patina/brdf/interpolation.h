#pragma once
// Interpolation weights on the axes of a table.

#include <span>

#include <Eigen/Dense>

namespace patina::brdf {

// Two neighbours and the weight of the upper one; clamped at the ends of an ascending axis.
struct LinearInterval {
    int lower = 0, upper = 0;
    double upper_weight = 0.0;
};
LinearInterval linear_interval(std::span<const double> ascending_axis, double value);

// The cubic through the four nearest points of an ascending axis (fewer when the axis is shorter); clamped at the ends.
struct CubicInterval {
    int first = 0, count = 1;
    double weights[4] = {1, 0, 0, 0};
};
CubicInterval cubic_interval(std::span<const double> ascending_axis, double value);

// Lagrange interpolation on fixed nodes in the barycentric form, stable for Gauss nodes (Berrut & Trefethen 2004, SIAM
// Review 46, eq. 4.2). The nodes must be distinct.
class BarycentricInterpolation {
  public:
    explicit BarycentricInterpolation(std::span<const double> nodes);

    // The values of the N Lagrange polynomials at x: sum = 1, a unit vector at a node.
    Eigen::VectorXd weights(double x) const;

  private:
    Eigen::VectorXd nodes_, barycentric_weights_;
};

}  // namespace patina::brdf
