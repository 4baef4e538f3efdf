#pragma once
// Reflection and transmission operators of one homogeneous layer, and the way solvers plug theirs in.

#include <Eigen/Dense>

#include "patina/core/progress.h"
#include "patina/rt/kernel.h"

namespace patina::rt {

// In the variables of TransferSystem: I+ enters at the top, Delta I- leaves there through `reflection`, I+ leaves at
// the bottom through `transmission` (unscattered light included). A homogeneous layer does the same seen from below.
template <class Scalar>
struct LayerOperators {
    using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
    Matrix reflection;
    Matrix transmission;  // empty for an infinite layer and when not asked for
};

struct LayerRequest {
    double optical_thickness = 0.0;  // > 0, may be infinite
    bool transmission = true;
    const CancelToken* cancel = nullptr;  // a stop throws Error(interrupted)
};

// What distinguishes one deterministic solver from another.
class LayerMethod {
  public:
    virtual ~LayerMethod() = default;
    virtual LayerOperators<double> solve(const TransferSystem<double>& system, const LayerRequest& request) const = 0;
};

}  // namespace patina::rt
