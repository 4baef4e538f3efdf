#pragma once
// How far the table of a reflection is from the converged BRDF, judged between its nodes by a finer solution.

#include <span>

#include "patina/brdf/mueller_table.h"
#include "patina/jobs/body_solution.h"

namespace patina::jobs {

// Directions up to this zenith angle, incident and outgoing, are judged. Nearer to grazing the body BRDF of an
// index-matched layer is singular (it grows like 1/(mu_o + mu_i)) and no finite table follows it.
inline constexpr double largest_judged_zenith_deg = 85.0;

// The BRDF of a table of one wavelength on a fixed grid of directions that are nodes of no quadrature: 15 x 15 zenith
// angles up to largest_judged_zenith_deg, closer where polynomials err most, and 10 azimuths from 0 to 180 deg.
brdf::MuellerGrid between_nodes(const BodySolution& body);

// Such a grid as numbers, for keeping, and back.
inline constexpr std::size_t judged_values = 15 * 15 * 10 * 16;
std::span<const double> to_values(const brdf::MuellerGrid& grid);
brdf::MuellerGrid to_grid(std::span<const double> values);

// A body BRDF below this, 1/sr, is black: it has nothing but rounding where nothing scatters, as varnish over a mirror.
// Errors are told in units of this then.
inline constexpr double darkest_scale = 1e-9;

// Largest difference of any Mueller element, and the largest f00, 1/sr, at least darkest_scale.
double largest_difference(const brdf::MuellerGrid& a, const brdf::MuellerGrid& b);
double intensity_scale(const brdf::MuellerGrid& grid);

}  // namespace patina::jobs
