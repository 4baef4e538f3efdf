#pragma once
// The size-averaged scattering matrix of spheres at Gauss angles, with the cross sections that belong to it.

#include <complex>
#include <span>

#include <Eigen/Dense>

#include "patina/math/quadrature.h"

namespace patina::optics {

// F at the nodes cos(theta) of a Gauss-Legendre rule on (-1, 1), ascending; see expansion_coefficients.h for the
// elements. Normalised so that (1/2) int a1 dcos = 1. For spheres a2 = a1 and a4 = a3.
struct ScatteringMatrix {
    math::Quadrature cosines;
    Eigen::ArrayXd a1, a2, a3, a4, b1, b2;  // same length as cosines
};

// Scales all elements to (1/2) int a1 dcos = 1 and returns that integral as it was. Precondition: a1 is not zero
// everywhere.
double normalize(ScatteringMatrix& matrix);

// Sums over spheres of the quantities that add up; divide by `number` for averages.
struct SphereSums {
    double number = 0.0;
    double radius2_um2 = 0.0, radius3_um3 = 0.0;
    double extinction_um2 = 0.0, scattering_um2 = 0.0, absorption_um2 = 0.0;
    // Sums of S11, S12, S33, S34 (Bohren & Huffman 1983, eq. 4.77; S34 = Im(S2 S1*)) at the positive nodes ascending,
    // then at their mirror images. shape [nodes][4]
    Eigen::ArrayX4d elements;

    // The sums of two disjoint sets of spheres.
    SphereSums& operator+=(const SphereSums& other);
};

// Number of Gauss nodes, even, that integrates products of F of a sphere up to size parameter x with any Wigner
// function that F contains.
int matrix_nodes(double size_parameter);

// Adds up spheres of the radii (ascending is fastest) with number weights, in a host where the wavenumber is 2 pi
// m_host / lambda, complex where it absorbs (MieSphere::in_absorbing_host). `cosines` is an even Gauss-Legendre rule on
// (-1, 1).
SphereSums sum_spheres(std::complex<double> relative_index, std::complex<double> wavenumber_per_um,
                       std::span<const double> radii_um, std::span<const double> weights,
                       const math::Quadrature& cosines);

// F of the sums.
ScatteringMatrix scattering_matrix(const SphereSums& sums, const math::Quadrature& cosines);

}  // namespace patina::optics
