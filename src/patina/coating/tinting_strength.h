#pragma once
// How strongly one paint colours compared with another: ISO 787-24, ASTM D4838.

#include <vector>

#include <Eigen/Dense>

#include "patina/coating/paint_metrics_stack.h"

namespace patina::coating {

// Both paints as films without end, d:8 with the specular reflection left out, freed of their surfaces by Saunderson's
// correction, with K/S = (1 - R)^2/(2 R) (Kubelka & Munk 1931). The concentrations are those of the recipes: equal ones
// of the pigments compared, in the same white, make the ratio a property of the pigments.
struct TintingStrength {
    std::vector<double> k_over_s, k_over_s_standard;  // one a wavelength
    double wavelength_nm = 0.0;                       // where the standard's K/S is largest
    double at_maximum = 0.0;  // K/S over the standard's there; of whites in the same black, its inverse is the relative
                              // scattering power
    double integrated = 0.0;  // sum of K/S over all wavelengths over the standard's
    double delta_e_2000 = 0.0;  // between the two films, D65 and 10 degrees, with their surfaces
};

// Solves both. Throws Error(input) when one does not scatter or the standard absorbs nothing, and what VariableStack
// throws. `options` hold for both.
TintingStrength tinting_strength(const Recipe& recipe, const Recipe& standard, const StackOptions& options,
                                 const JobControl& control = {});

}  // namespace patina::coating
