#pragma once
// The scattering matrix of randomly oriented particles, as coefficients of generalized spherical functions.

#include <vector>

namespace patina::optics {

// F = [[a1,b1,0,0],[b1,a2,0,0],[0,0,a3,b2],[0,0,-b2,a4]], (1/2) int a1 d(cos) = 1, expanded as
// a1 = sum alpha1 d^l_00, a4 = sum alpha4 d^l_00, a2 + a3 = sum (alpha2 + alpha3) d^l_22,
// a2 - a3 = sum (alpha2 - alpha3) d^l_2,-2, b1 = -sum beta1 d^l_02, b2 = -sum beta2 d^l_02
// (de Haan, Bosma & Hovenier 1987, A&A 183, 371, with d for their P). All six have the same length, order() + 1.
struct ExpansionCoefficients {
    std::vector<double> alpha1, alpha2, alpha3, alpha4, beta1, beta2;

    int order() const { return static_cast<int>(alpha1.size()) - 1; }
    // <cos theta>.
    double asymmetry() const { return order() >= 1 ? alpha1[1] / 3.0 : 0.0; }
};

}  // namespace patina::optics
