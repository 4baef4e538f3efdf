#pragma once
// A rough metal as an operator on the rays of the medium above it, Fourier order by order.

#include <optional>
#include <vector>

#include "patina/core/progress.h"
#include "patina/rt/kernel.h"
#include "patina/rt/microfacets.h"

namespace patina::rt {

// In the variables of TransferSystem. Facets scatter once; what they lose to light that meets several facets, and what
// the quadrature misses of their lobes, is given back by factors c_o c_i (Sinkhorn & Knopp 1967, Pacific J. Math. 21,
// 343) that make the sum over all rays exactly 1 for facets that absorb nothing, and keep reciprocity.
class RoughBoundary {
  public:
    // A stop throws Error(interrupted).
    RoughBoundary(const RoughSurface& surface, const Medium& upper, std::complex<double> metal, int streams,
                  const CancelToken* cancel = nullptr);

    int order() const { return order_; }
    // Largest deviation of c^2 from 1 on rays steeper than 60 degrees: how well the rays resolve the lobes.
    double correction() const { return correction_; }

    // Downward light to upward light, the latter times Delta.
    Eigen::MatrixXd scattering(int m, Components components) const;

  private:
    const Medium* upper_;
    int order_ = 0;
    double correction_ = 0.0;
    std::vector<Eigen::MatrixXd> modes_;
};

}  // namespace patina::rt
