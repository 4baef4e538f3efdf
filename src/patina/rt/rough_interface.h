#pragma once
// A rough interface between two transparent media as operators on the rays of both, Fourier order by order.
//
// Facets scatter once with Smith's shadowing (microfacets.h); light that meets several of them is given back in
// proportion to what each direction loses (Kelemen & Szirmay-Kalos 2001, Eurographics short presentations; Kulla &
// Conty 2017, SIGGRAPH course), here to both sides at once: with l = (1 - E_I, -E_Q) what a direction loses of I and of
// Q, E its albedo, the matrix l_o l_i^T over the sum of (1 - E_I) flux_weight. That is reciprocal, its intensity is
// positive, and it makes the sum over all rays exactly 1 for each incidence and polarization from either side.
//
// Refracted lobes are a few times narrower than reflected ones and than the spacing of the rays. Between quadrature
// rays they are averaged over the rays' cells of flux, the same cells in both media, so that fluxes are right whatever
// the width, and a vanishing width leaves the smooth interface. Reflected lobes are taken at the rays and made to carry
// the cells' flux by factors c_o c_i (balance.h), one set for each side. View and beam rays have the facets' own
// values.

#include <array>
#include <vector>

#include "patina/core/progress.h"
#include "patina/rt/kernel.h"
#include "patina/rt/microfacets.h"

namespace patina::rt {

class RoughInterface {
  public:
    // `most_orders` = 1 leaves out all but the azimuthal mean. A stop throws Error(interrupted).
    RoughInterface(const RoughSurface& surface, const std::vector<Ray>& rays, const Medium& upper, const Medium& lower,
                   int streams, int most_orders = 0, const CancelToken* cancel = nullptr);

    int order() const { return order_; }
    // Largest |c^2 - 1| on rays steeper than 60 degrees: how well the rays resolve the reflected lobes.
    double correction() const { return correction_; }

    // In the variables of TransferSystem; "above" and "below" tell where light comes from and, reflected, goes to.
    struct Operators {
        Eigen::MatrixXd reflection_above, reflection_below, transmission_down, transmission_up;
    };
    Operators operators(int m, Components components) const;

  private:
    using Modes = std::vector<Eigen::MatrixXd>;  // [m], 4x4 blocks (o, i), upward light not yet times Delta
    void close_energy(const Eigen::VectorXd& upper_albedo, const Eigen::VectorXd& lower_albedo);

    const Medium &upper_, &lower_;
    int order_ = 0;
    double correction_ = 0.0;
    Modes above_, below_, down_;  // reflection on either side; transmission up is the reverse of that down
};

}  // namespace patina::rt
