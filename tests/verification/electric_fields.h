#pragma once
// Polarization worked out from electric fields in space, exp(-i w t), to hold the renderer's Mueller matrices against.

#include <complex>

#include <Eigen/Dense>

#include "patina/optics/fresnel.h"

namespace patina::render::test {

using Complex = std::complex<double>;
using Eigen::Vector3cd;
using Eigen::Vector3d;

// What a camera that looks along `view` with this up vector measures of the field Re(E exp(-i w t)): x right, y up,
// V > 0 clockwise.
inline Eigen::Vector4d measured(const Vector3cd& field, const Vector3d& view, const Vector3d& up) {
    const Vector3d x = view.cross(up).normalized(), y = x.cross(view);
    const Complex ex = x.cast<Complex>().dot(field), ey = y.cast<Complex>().dot(field);
    const Complex product = ex * std::conj(ey);
    return {std::norm(ex) + std::norm(ey), std::norm(ex) - std::norm(ey), 2 * product.real(), 2 * product.imag()};
}

// Field after reflection at a plane with this normal.
inline Vector3cd reflected(const Vector3cd& field, const Vector3d& k_in, const Vector3d& normal, Complex index) {
    const Vector3d k_out = k_in - 2 * normal.dot(k_in) * normal, s = normal.cross(k_in).normalized();
    const auto amplitude = optics::fresnel_amplitudes(-normal.dot(k_in), 1.0, index);
    const Vector3d p_in = s.cross(k_in), p_out = s.cross(k_out);
    return amplitude.r_s * s.cast<Complex>().dot(field) * s.cast<Complex>() +
           amplitude.r_p * p_in.cast<Complex>().dot(field) * p_out.cast<Complex>();
}

}  // namespace patina::render::test
