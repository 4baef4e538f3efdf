#pragma once
// One layer by its eigenmodes.
//
// G H v = k^2 v gives the solutions S = v e^{-kt}, D = H v e^{-kt}/k, and their mirror images. With A = (V + H V/k)/2,
// B = (V - H V/k)/2 and E = e^{-k tau}, light entering both faces equally (+) or with opposite signs (-) leaves as
// R +- T = (B +- A E)(A +- B E)^-1: decaying exponentials only, for all incidences at once, no particular solutions.
// (Stamnes et al. 1988, Appl. Opt. 27, 2502; Siewert 2000, JQSRT 64, 227 for complex eigenvalues.)

#include "patina/rt/layer_operators.h"

namespace patina::rt {

class EigenmodeMethod final : public LayerMethod {
  public:
    LayerOperators<double> solve(const TransferSystem<double>& system, const LayerRequest& request) const override;
};

}  // namespace patina::rt
