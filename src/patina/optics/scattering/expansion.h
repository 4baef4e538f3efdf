#pragma once
// Scattering matrix <-> expansion coefficients.

#include "patina/optics/scattering/expansion_coefficients.h"
#include "patina/optics/scattering/scattering_matrix.h"

namespace patina::optics {

// The six elements at one angle.
struct ScatteringElements {
    double a1, a2, a3, a4, b1, b2;
};

// Coefficients by Gauss quadrature on the matrix' own nodes (de Haan, Bosma & Hovenier 1987, eqs 68-73), up to the
// first order beyond which every coefficient stays below `tolerance`; at least order 2. Exact for matrices whose degree
// is below the number of nodes. An alpha1[0] other than 1, from a matrix that is not normalised, is kept.
ExpansionCoefficients expand(const ScatteringMatrix& matrix, double tolerance);

// F at a cosine of the scattering angle.
ScatteringElements evaluate(const ExpansionCoefficients& coefficients, double cosine);

// F at the nodes of a rule.
ScatteringMatrix evaluate(const ExpansionCoefficients& coefficients, const math::Quadrature& cosines);

// How far F breaks Stokes' criterion, that no light is polarized more than fully: the largest sqrt(Q^2 + U^2 + V^2) - I
// of light scattered once, over the scattering angles and all fully polarized incident light of I = 1, where a1 is 1 on
// average. 0 for what matter can do; also where intensity would be negative it is above 0.
struct StokesCriterion {
    double excess, angle_deg;
    double largest_a1;
};
StokesCriterion stokes_criterion(const ExpansionCoefficients& coefficients);

// sum += weight * term, the shorter filled with zeros.
void add(ExpansionCoefficients& sum, const ExpansionCoefficients& term, double weight);

// Drops the orders beyond which every coefficient stays below `tolerance`; keeps at least order 2.
void truncate(ExpansionCoefficients& coefficients, double tolerance);

}  // namespace patina::optics
