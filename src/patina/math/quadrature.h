#pragma once
// Gauss-Legendre quadrature.

#include <vector>

namespace patina::math {

struct Quadrature {
    std::vector<double> nodes;    // ascending
    std::vector<double> weights;  // same length, positive

    int size() const { return static_cast<int>(nodes.size()); }
};

// n-point Gauss-Legendre rule on (lower, upper), exact for polynomials of degree 2n-1, to rounding for n up to 10^4.
// Newton's iteration on P_n from Tricomi's initial guess (Abramowitz & Stegun 1964, 25.4.29-30).
Quadrature gauss_legendre(int n, double lower = -1.0, double upper = 1.0);

}  // namespace patina::math
