#pragma once
// One layer by its eigenmodes.
//
// G H v = k^2 v gives the solutions that are even and odd about the middle of the layer, S = V cosh kx, D = -k^2 W
// (sinh kx)/k and S = V (sinh kx)/k, D = -W cosh kx with W = G^-1 V: regular at k = 0, where a conservative layer has
// one mode. With E = e^{-k tau}, light entering both faces equally (+) or with opposite signs (-) leaves as
//   R +- T = (V P - W Q)(V P + W Q)^-1,  P = 1 + E, Q = k (1 - E) for +,  P = (1 - E)/k, Q = 1 + E for -:
// decaying exponentials only, for all incidences at once, no particular solutions. (Stamnes et al. 1988, Appl. Opt. 27,
// 2502; Siewert 2000, JQSRT 64, 227 for complex eigenvalues.)

#include "patina/rt/layer_operators.h"

namespace patina::rt {

class EigenmodeMethod final : public LayerMethod {
  public:
    LayerOperators<double> solve(const TransferSystem<double>& system, const LayerRequest& request) const override;
};

}  // namespace patina::rt
