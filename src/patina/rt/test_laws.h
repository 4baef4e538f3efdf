#pragma once
// What tests measure on a solved reflection: the flux it returns, and how far it is from reciprocity.

#include <algorithm>

#include "patina/core/constants.h"
#include "patina/rt/solver.h"

namespace patina::rt::testing_problems {

// Directional-hemispherical reflectance of unpolarized light, surface and coherent reflection included.
inline Eigen::VectorXd reflectance(const Problem& problem, const Reflection& r) {
    const int n = static_cast<int>(r.mu.size());
    Eigen::VectorXd total = Eigen::VectorXd::Zero(n);
    for (int i = 0; i < n; ++i) {
        for (int o = 0; o < n; ++o) total[i] += 2 * pi * r.weights[o] * r.mu[o] * r.modes[0](4 * o, 4 * i);
        total[i] += specular_surface(problem, r.mu[i])(0, 0) + specular_coherent(problem, r.mu[i])(0, 0);
    }
    return total;
}

// Largest |f(i,o) - Q f(o,i)^T Q| over all orders, relative to the BRDF.
inline double reciprocity_error(const Reflection& r) {
    const int n = static_cast<int>(r.mu.size());
    double worst = 0.0;
    for (const Eigen::MatrixXd& f : r.modes)
        for (int o = 0; o < n; ++o)
            for (int i = 0; i < n; ++i) {
                const optics::Mueller a = f.block<4, 4>(4 * o, 4 * i), b = f.block<4, 4>(4 * i, 4 * o);
                worst = std::max(worst,
                                 (a - optics::reversal() * b.transpose() * optics::reversal()).cwiseAbs().maxCoeff());
            }
    return worst / r.modes[0].cwiseAbs().maxCoeff();
}

}  // namespace patina::rt::testing_problems
