#pragma once
// From a recipe to the radiative transfer problem of one wavelength: Mie, mixing rules, optical thickness.

#include <string>
#include <vector>

#include "patina/coating/recipe.h"
#include "patina/rt/problem.h"

namespace patina::coating {

struct OpticalProblem {
    rt::Problem problem;
    std::vector<std::string> notes;      // what was assumed: extrapolated constants, packing, unknown k
    std::vector<std::string> citations;  // "name: publication" of every material used
};

// The problem at a vacuum wavelength. `tolerance` bounds the relative error of cross sections and coefficients.
//
// A layer of thickness d holds N_p = f_p / <V_p> particles per volume of each pigment p (f_p volume fraction, <V> mean
// volume), so that tau = d (sum N_p C_ext,p + (1 - f) 4 pi k_host / lambda); the binder's own absorption is added to
// that of real-host Mie, which holds for k_host <= 1e-4 (Mishchenko & Yang 2018, J. Quant. Spectrosc. Radiat. Transf.
// 205, 241); a stronger absorption is an Error(input).
OpticalProblem optical_problem(const Recipe& recipe, double wavelength_nm, double tolerance = 1e-5);

}  // namespace patina::coating
