#pragma once
// Light on its way into a slab and out again, both ways attenuated exponentially: what scattering once needs.

#include <algorithm>
#include <cmath>

namespace patina::math {

// int_0^T exp(-t a) exp(-(T-t) b) dt: in at one side and out of the other. T may be infinite.
inline double path_through(double a, double b, double thickness) {
    if (std::isinf(thickness)) return 0.0;
    const double slow = std::min(a, b), apart = std::abs(a - b);
    return std::exp(-thickness * slow) *
           (apart * thickness > 0.0 ? -std::expm1(-apart * thickness) / apart : thickness);
}

// int_0^T exp(-t (a+b)) dt: out of the side it came in.
inline double path_back(double a, double b, double thickness) {
    return -std::expm1(-thickness * (a + b)) / (a + b);
}

}  // namespace patina::math
