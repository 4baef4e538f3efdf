#pragma once
// A base known by its BRDF as an operator on the rays of the medium above it, Fourier order by order.

#include "patina/rt/kernel.h"
#include "patina/rt/nodes.h"
#include "patina/rt/problem.h"

namespace patina::rt {

// In the variables of TransferSystem, without the delta part (boundary.h, mirror). The rays sum up the surface's albedo
// only to their quadrature error: factors c_o c_i (balance.h) make the sum exact for each ray and keep reciprocity.
class SurfaceBoundary {
  public:
    // All must outlive this.
    SurfaceBoundary(const SurfaceReflection& surface, const Medium& upper);

    int order() const { return surface_.order(); }
    // How far the rays are from integrating the surface's BRDF.
    double correction() const { return correction_; }

    // Downward light to upward light, the latter times Delta.
    Eigen::MatrixXd scattering(int m, Components components) const;

  private:
    Eigen::MatrixXd unbalanced(int m) const;

    const SurfaceReflection& surface_;
    const Medium& upper_;
    Eigen::VectorXd factors_;
    double correction_ = 0.0;
};

}  // namespace patina::rt
