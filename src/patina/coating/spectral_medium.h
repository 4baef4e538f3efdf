#pragma once
// A layer of a recipe by itself, as a medium that fills space.

#include "patina/coating/recipe.h"
#include "patina/optics/scattering/spectral_medium.h"

namespace patina::coating {

// Coefficients per um and scattering matrices at `count` wavelengths of a regular grid. `layer` counts from the top, -1
// is the topmost that scatters. `tolerance` as in optical_problem(). Throws Error(input) for a layer that is not there
// and for one given in optical terms, which has no length, and whatever optical_problem() throws.
optics::SpectralMedium spectral_medium(const Recipe& recipe, int layer, double first_nm, double step_nm, int count,
                                       double tolerance = 1e-5);

}  // namespace patina::coating
