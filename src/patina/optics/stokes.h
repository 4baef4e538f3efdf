#pragma once
// Stokes vectors and Mueller matrices in the convention of the solver (docs/conventions.md).
//
// A Stokes vector is (I, Q, U, V) with Q = I_par - I_perp with respect to the meridian plane of the ray, time factor
// exp(-i w t), complex refractive index m = n + i k. U = 2 Re(E_p E_s*), V = -2 Im(E_p E_s*) for the ray's own basis
// p = e_theta direction, s = e_phi direction, s x p = k (Bohren & Huffman 1983, section 2.11).

#include <Eigen/Dense>

namespace patina::optics {

using Stokes = Eigen::Vector4d;
using Mueller = Eigen::Matrix4d;

// diag(1, 1, -1, 1): reverses a light path, f(i, o) = reversal f(o, i)^T reversal.
inline Mueller reversal() { return Eigen::Vector4d(1, 1, -1, 1).asDiagonal(); }

// sqrt(Q^2 + U^2 + V^2) / I and its parts; 0 for a dark ray.
inline double degree_of_polarization(const Stokes& s) { return s[0] > 0 ? s.tail<3>().norm() / s[0] : 0.0; }
inline double degree_of_linear_polarization(const Stokes& s) { return s[0] > 0 ? s.segment<2>(1).norm() / s[0] : 0.0; }

}  // namespace patina::optics
