#pragma once
// Wavelengths for a table that is linear between them, found by bisection.

#include <vector>

#include "patina/coating/recipe.h"
#include "patina/core/progress.h"

namespace patina::jobs {

struct WavelengthChoice {
    std::vector<double> wavelengths_nm;  // ascending, both ends of the range included
    // Nothing known of wavelengths that were given. Else the estimated largest error of linear interpolation between
    // them, in units of the largest f00 at the same wavelength.
    double interpolation_error = 0.0;
    bool converged = true;  // else an interval of the smallest width is still too wide
};

// Starts from intervals of at most 25 nm and halves each until the BRDF in its middle differs from the mean of its ends
// by so little that the halves err by less than `tolerance`. Linear interpolation errs by h^2 f''/8: a quarter of the
// difference remains for a half, and twice that is asked to be within the tolerance. Intervals are not halved below 1
// nm. Few streams are enough to see how the BRDF varies: their error varies with wavelength as slowly as the BRDF.
// Throws Error(interrupted) when stopped.
WavelengthChoice choose_wavelengths(const coating::Recipe& recipe, double from_nm, double to_nm, double tolerance,
                                    const JobControl& control);

}  // namespace patina::jobs
