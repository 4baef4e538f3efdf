#pragma once
// A rough interface or metal as operators on the rays of the media it separates, Fourier order by order.

#include <optional>
#include <vector>

#include "patina/rt/kernel.h"
#include "patina/rt/microfacets.h"

namespace patina::rt {

// In the variables of TransferSystem. Facets scatter once; what they lose to light that meets several facets, and what
// the quadrature misses of their lobes, is given back by factors c_o c_i (Sinkhorn & Knopp 1967, Pacific J. Math. 21,
// 343) that make the sum over all rays exactly 1 for facets that absorb nothing, and keep reciprocity.
class RoughBoundary {
  public:
    // A rough interface between two transparent media, or with `metal` a rough metal under `upper` (no `lower` then).
    RoughBoundary(const RoughSurface& surface, const Medium& upper, const Medium* lower,
                  std::optional<std::complex<double>> metal, int streams);

    int order() const { return order_; }
    // Largest deviation of c^2 from 1 on rays steeper than 60 degrees: how well the rays resolve the lobes.
    double correction() const { return correction_; }

    // All rays of the upper medium, then those of the lower: light going in (down in the upper, up in the lower one) to
    // light going out, upward light times Delta.
    Eigen::MatrixXd scattering(int m, Components components) const;
    int upper_size() const { return upper_->size(); }

  private:
    const Medium* upper_;
    const Medium* lower_;
    int order_ = 0;
    double correction_ = 0.0;
    std::vector<Eigen::MatrixXd> modes_;
};

}  // namespace patina::rt
