#pragma once
// From a recipe to the radiative transfer problem of one wavelength: Mie, mixing rules, optical thickness.

#include <string>
#include <vector>

#include "patina/coating/recipe.h"
#include "patina/optics/scattering/mixture.h"
#include "patina/rt/problem.h"

namespace patina::coating {

struct OpticalProblem {
    rt::Problem problem;
    // Of each layer, the particles in the order of its pigments; none of a layer in optical terms.
    std::vector<std::vector<optics::MixtureComponent>> particles;
    std::vector<std::string> notes;      // what was assumed: extrapolated constants, packing, unknown k
    std::vector<std::string> citations;  // "name: publication" of every material used
};

// The problem at a vacuum wavelength. `tolerance` bounds the relative error of cross sections and coefficients.
//
// A layer of thickness d holds N_p = f_p / <V_p> particles per volume of each pigment p (f_p volume fraction, <V> mean
// volume), so that tau = d (4 pi k_host / lambda + sum N_p C_ext,p). C_ext of a sphere in an absorbing binder is that
// of the coherent field and counts the binder it replaces (MieSphere::in_absorbing_host); particles known from
// elsewhere keep their cross sections but for 4 pi k_host V / lambda. Refraction takes the binder's n alone. Throws
// Error(input) for a binder of k > 0.05, and where the particles would scatter more than the layer extinguishes.
OpticalProblem optical_problem(const Recipe& recipe, double wavelength_nm, double tolerance = 1e-5);

}  // namespace patina::coating
