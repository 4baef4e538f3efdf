#pragma once
// Interference between densely packed particles: the Percus-Yevick structure factor of hard spheres.

#include "patina/optics/scattering/scattering_matrix.h"

namespace patina::optics {

// Random close packing of equal spheres; no suspension of hard spheres is denser.
inline constexpr double max_packing_fraction = 0.64;

// S(q) of hard spheres of one diameter d filling the volume fraction f (Percus & Yevick 1958; Wertheim 1963; the form
// of Kinning & Thomas 1984). S -> 1 for f -> 0 or q d -> inf, S(0) = (1-f)^4/(1+2f)^2. 0 <= f <= max_packing_fraction,
// qd >= 0.
double percus_yevick(double volume_fraction, double q_times_diameter);

// Multiplies F(theta) by S(q), q = 2 k sin(theta/2), normalises it again and returns <S> = (1/2) int a1 S dcos, by
// which the scattering cross section of a particle shrinks. Polarization by a single particle is not changed by packing
// in this theory (each particle sees the incident plane wave: the interference approximation of Fraden & Maret 1990).
double apply_structure_factor(ScatteringMatrix& matrix, double volume_fraction, double wavenumber_per_um,
                              double diameter_um);

}  // namespace patina::optics
