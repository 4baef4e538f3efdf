#include "patina/brdf/interpolation.h"

#include <algorithm>

#include "patina/core/contract.h"

namespace patina::brdf {

LinearInterval linear_interval(std::span<const double> axis, double value) {
    PATINA_EXPECT(!axis.empty());
    const int last = static_cast<int>(axis.size()) - 1;
    if (!(value > axis.front())) return {0, 0, 0.0};
    if (value >= axis.back()) return {last, last, 0.0};
    const int upper = static_cast<int>(std::upper_bound(axis.begin(), axis.end(), value) - axis.begin());
    return {upper - 1, upper, (value - axis[upper - 1]) / (axis[upper] - axis[upper - 1])};
}

CubicInterval cubic_interval(std::span<const double> axis, double value) {
    const int size = static_cast<int>(axis.size()), lower = linear_interval(axis, value).lower;
    CubicInterval interval;
    interval.count = std::min(size, 4);
    interval.first = std::clamp(lower - 1, 0, size - interval.count);
    const double x = std::clamp(value, axis.front(), axis.back());
    for (int j = 0; j < interval.count; ++j) {
        interval.weights[j] = 1.0;
        for (int k = 0; k < interval.count; ++k)
            if (k != j)
                interval.weights[j] *=
                    (x - axis[interval.first + k]) / (axis[interval.first + j] - axis[interval.first + k]);
    }
    return interval;
}

BarycentricInterpolation::BarycentricInterpolation(std::span<const double> nodes)
    : nodes_(Eigen::VectorXd::Map(nodes.data(), static_cast<Eigen::Index>(nodes.size()))),
      barycentric_weights_(Eigen::VectorXd::Ones(nodes_.size())) {
    PATINA_EXPECT(!nodes.empty());
    // Differences are scaled by the capacity of the interval, a quarter of its length, so that no product under- or
    // overflows (Berrut & Trefethen 2004, section 7). A common factor of the weights cancels in the barycentric form.
    const double capacity = std::max((nodes.back() - nodes.front()) / 4, 1e-300);
    for (Eigen::Index j = 0; j < nodes_.size(); ++j)
        for (Eigen::Index k = 0; k < nodes_.size(); ++k)
            if (k != j) barycentric_weights_[j] *= capacity / (nodes_[j] - nodes_[k]);
}

Eigen::VectorXd BarycentricInterpolation::weights(double x) const {
    Eigen::VectorXd result(nodes_.size());
    for (Eigen::Index j = 0; j < nodes_.size(); ++j) {
        if (x == nodes_[j]) return Eigen::VectorXd::Unit(nodes_.size(), j);
        result[j] = barycentric_weights_[j] / (x - nodes_[j]);
    }
    return result / result.sum();
}

}  // namespace patina::brdf
