#pragma once
// Problems that several verification tests solve.

#include <gtest/gtest.h>

#include "patina/jobs/validation/siewert.h"
#include "patina/jobs/validation/siewert2000_data.h"
#include "patina/rt/solver.h"

namespace patina::rt::testing_problems {

// Statistical solvers are held to their error bars, in tests/cross.
inline std::vector<std::string> solver_names() {
    std::vector<std::string> names;
    for (const auto& solver : solvers())
        if (!solver->is_statistical()) names.emplace_back(solver->name());
    return names;
}

inline Problem siewert() {
    return jobs::validation::siewert_problem();
}

inline optics::ExpansionCoefficients rayleigh() {
    optics::ExpansionCoefficients x;
    x.alpha1 = {1, 0, 0.5};
    x.alpha2 = {0, 0, 3};
    x.alpha3 = {0, 0, 0};
    x.alpha4 = {0, 1.5, 0};
    x.beta1 = {0, 0, std::sqrt(6.0) / 2};
    x.beta2 = {0, 0, 0};
    return x;
}

// Scattering that knows no polarization, from the Legendre coefficients of the phase function.
inline optics::ExpansionCoefficients unpolarizing(std::vector<double> alpha1) {
    optics::ExpansionCoefficients x;
    const std::vector<double> none(alpha1.size(), 0.0);
    x.alpha1 = std::move(alpha1);
    x.alpha2 = x.alpha3 = x.alpha4 = x.beta1 = x.beta2 = none;
    return x;
}

inline optics::ExpansionCoefficients henyey_greenstein(double g, int order) {
    std::vector<double> alpha1(order + 1);
    for (int l = 0; l <= order; ++l) alpha1[l] = (2 * l + 1) * std::pow(g, l);
    return unpolarizing(std::move(alpha1));
}

}  // namespace patina::rt::testing_problems
