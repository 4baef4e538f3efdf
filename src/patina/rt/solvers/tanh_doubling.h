#pragma once
// The doubling core: hyperbolic tangents and cotangents of a matrix.
//
// Light entering a layer of thickness 2h equally on both faces leaves D = X S at the top, light entering with opposite
// signs D = U S; X is h H tanh(z)/z and U (h G)^-1 z coth(z) with z^2 = h^2 G H. Both start from continued fractions of
// a thin layer and double by coth 2z = (tanh z + coth z)/2, tanh 2z = 2/(tanh z + coth z):
//     U <- (X + U)/2,  X <- 2 (X - X (X + U)^-1 X).
// No differences of nearly equal numbers and no eigenvalues: conservative scattering (X isotropic = 0) and any
// thickness keep full accuracy. Reflection and transmission are the half sum and half difference of (1 - X)/(1 + X), (1
// - U)/(1 + U).

#include "patina/rt/layer_operators.h"

namespace patina::rt {

// Scalar is double or long double.
template <class Scalar>
LayerOperators<Scalar> tanh_doubling(const TransferSystem<Scalar>& system, const LayerRequest& request);

extern template LayerOperators<double> tanh_doubling(const TransferSystem<double>&, const LayerRequest&);
extern template LayerOperators<long double> tanh_doubling(const TransferSystem<long double>&, const LayerRequest&);

class DoublingMethod final : public LayerMethod {
  public:
    LayerOperators<double> solve(const TransferSystem<double>& system, const LayerRequest& request) const override {
        return tanh_doubling(system, request);
    }
};

}  // namespace patina::rt
