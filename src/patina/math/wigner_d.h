#pragma once
// Wigner d functions d^l_mn(theta), the generalized spherical functions of polarized scattering.

#include <span>
#include <vector>

namespace patina::math {

// d^l_mn at x = cos(theta) for l = 0 .. order, in Mishchenko's convention: d^l_00 = P_l(x),
// d^2_20 = d^2_02 = sqrt(6)/4 (1 - x^2), d^2_22 = (1 + x)^2/4, d^2_2,-2 = (1 - x)^2/4.
// Values below l = max(|m|,|n|) are zero. Upward recurrence in l: Mishchenko, Travis & Lacis (2002) Scattering, Absorption
// and Emission of Light by Small Particles, eqs B.22-B.24. |x| <= 1.
std::vector<double> wigner_d(int order, int m, int n, double x);

}  // namespace patina::math
