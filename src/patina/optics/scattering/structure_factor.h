#pragma once
// Interference between densely packed particles: the Percus-Yevick structure factor of hard spheres.

#include <span>

#include <Eigen/Dense>

#include "patina/math/quadrature.h"
#include "patina/optics/scattering/expansion_coefficients.h"
#include "patina/optics/scattering/scattering_matrix.h"

namespace patina::optics {

// Random close packing of equal spheres; no suspension of hard spheres is denser.
inline constexpr double max_packing_fraction = 0.64;

// S(q) of hard spheres of one diameter d filling the volume fraction f (Percus & Yevick 1958; Wertheim 1963; the form
// of Kinning & Thomas 1984). S -> 1 for f -> 0 or q d -> inf, S(0) = (1-f)^4/(1+2f)^2. 0 <= f <= max_packing_fraction,
// qd >= 0.
double percus_yevick(double volume_fraction, double q_times_diameter);

// Partial structure factors S_ij(q) of a mixture of hard spheres of the diameters d_i at the number densities n_i,
// whose volumes add up to max_packing_fraction at most (Baxter 1970, J. Chem. Phys. 52, 4559): a mixture of amplitudes
// A_i scatters sum_ij sqrt(n_i n_j) A_i A_j S_ij. Symmetric, positive definite; the unit matrix for n -> 0 or q -> inf.
// Lengths in one unit, q >= 0 in its inverse. shape [kinds][kinds]
Eigen::MatrixXd percus_yevick_mixture(std::span<const double> diameters, std::span<const double> number_densities,
                                      double q);

// F at the angles of `cosines`, of particles that are to be packed: the amplitudes of what interferes are roots of a1.
// Throws Error(input) where a1 is negative by more than the rounding of coefficients given with few digits.
ScatteringMatrix matrix_to_pack(const ExpansionCoefficients& expansion, const math::Quadrature& cosines);

// Multiplies F(theta) by S(q), q = 2 k sin(theta/2), normalises it again and returns <S> = (1/2) int a1 S dcos, by
// which the scattering cross section of a particle shrinks. Polarization by a single particle is not changed by packing
// in this theory (each particle sees the incident plane wave: the interference approximation of Fraden & Maret 1990).
double apply_structure_factor(ScatteringMatrix& matrix, double volume_fraction, double wavenumber_per_um,
                              double diameter_um);

}  // namespace patina::optics
