#pragma once
// Scattering laws for tests.

#include <cmath>
#include <random>

#include "patina/math/quadrature.h"
#include "patina/math/wigner_d.h"
#include "patina/optics/scattering/expansion_coefficients.h"

namespace patina::rt::testing_problems {

// Expansion of the scattering matrix of a mixture of pure states: amplitudes S1, S2 that are random polynomials in the
// cosine make F a sum of Jones matrices, hence physically realizable, with b2 != 0. S1 = +-S2 forward and backward.
inline optics::ExpansionCoefficients physical_expansion(unsigned seed, int order = 8) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const int degree = order / 2;
    const math::Quadrature rule = math::gauss_legendre(2 * order + 4);
    const int points = rule.size();
    Eigen::VectorXd a1 = Eigen::VectorXd::Zero(points), b1 = a1, a3 = a1, b2 = a1;
    for (int species = 0; species < 2; ++species) {
        // S1 + S2 = (1+x) p(x), S2 - S1 = (1-x) q(x) times -1: the angular structure of spheres (Bohren &
        // Huffman 4.74).
        std::vector<std::complex<double>> p(degree), q(degree);
        for (int k = 0; k < degree; ++k) {
            p[k] = std::complex(normal(random) + (k == 0 ? 2.0 : 0.0), normal(random)) / (k + 1.0);
            q[k] = std::complex(normal(random), normal(random)) / (2.0 * (k + 1.0));
        }
        for (int i = 0; i < points; ++i) {
            const double x = rule.nodes[i];
            std::complex<double> sum = 0, difference = 0;
            for (int k = degree - 1; k >= 0; --k) {
                sum = sum * x + p[k];
                difference = difference * x + q[k];
            }
            sum *= 1 + x;
            difference *= 1 - x;
            const auto s1 = 0.5 * (sum + difference), s2 = 0.5 * (sum - difference);
            a1[i] += 0.5 * (std::norm(s1) + std::norm(s2));
            b1[i] += 0.5 * (std::norm(s2) - std::norm(s1));
            a3[i] += (s2 * std::conj(s1)).real();
            b2[i] += (s2 * std::conj(s1)).imag();
        }
    }

    // Project with int d^l_mn d^l'_mn dx = 2/(2l+1) delta.
    optics::ExpansionCoefficients c;
    for (auto* list : {&c.alpha1, &c.alpha2, &c.alpha3, &c.alpha4, &c.beta1, &c.beta2}) list->assign(order + 1, 0.0);
    std::vector<double> plus(order + 1), minus(order + 1);
    for (int i = 0; i < points; ++i) {
        const double x = rule.nodes[i], w = rule.weights[i];
        const auto d00 = math::wigner_d(order, 0, 0, x), d02 = math::wigner_d(order, 0, 2, x);
        const auto d22 = math::wigner_d(order, 2, 2, x), d2m = math::wigner_d(order, 2, -2, x);
        for (int l = 0; l <= order; ++l) {
            const double factor = 0.5 * (2 * l + 1) * w;
            c.alpha1[l] += factor * a1[i] * d00[l];
            c.alpha4[l] += factor * a3[i] * d00[l];
            c.beta1[l] -= factor * b1[i] * d02[l];
            c.beta2[l] -= factor * b2[i] * d02[l];
            plus[l] += factor * (a1[i] + a3[i]) * d22[l];
            minus[l] += factor * (a1[i] - a3[i]) * d2m[l];
        }
    }
    const double norm = c.alpha1[0];
    for (int l = 0; l <= order; ++l) {
        c.alpha2[l] = 0.5 * (plus[l] + minus[l]);
        c.alpha3[l] = 0.5 * (plus[l] - minus[l]);
    }
    for (auto* list : {&c.alpha1, &c.alpha2, &c.alpha3, &c.alpha4, &c.beta1, &c.beta2})
        for (double& value : *list) value /= norm;
    c.alpha1[0] = 1.0;
    return c;
}

}  // namespace patina::rt::testing_problems
