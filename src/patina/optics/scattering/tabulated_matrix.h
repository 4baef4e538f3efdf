#pragma once
// Scattering matrices given by the user against angle: measured ones, or T-matrix results for particles that are not
// spheres.

#include <vector>

#include "patina/core/error.h"
#include "patina/optics/scattering/expansion_coefficients.h"

namespace patina::optics {

// The six elements at scattering angles; all columns of the same length. Only the shape counts: a1 is normalised.
struct ScatteringTable {
    std::vector<double> angles_deg;  // ascending from 0 to 180
    std::vector<double> a1, a2, a3, a4, b1, b2;
};

// Throws Error(input) at `where` if columns differ in length, angles do not ascend from 0 to 180, a1 is not positive, a
// value is not finite or a matrix would polarize more than fully: |element| > a1 (1 + 1e-3).
void validate(const ScatteringTable& table, const SourceLocation& where = {});

// Expansion coefficients of cubic splines through the columns against angle, with zero slope at 0 and 180 degrees,
// where symmetry has it; truncated at `tolerance`. The splines' own error falls with the fourth power of the spacing of
// the angles. At 0 and 180 degrees b1 and b2 are taken as zero.
// Throws Error(input) like validate(), and where the spline through a1 would become negative.
ExpansionCoefficients expand(const ScatteringTable& table, double tolerance, const SourceLocation& where = {});

}  // namespace patina::optics
