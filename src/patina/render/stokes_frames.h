#pragma once
// The bridge between the solver's polarization convention and the renderer's, and rotations of Stokes frames.
//
// Both conventions refer a Stokes vector to a frame (x, y, k), right-handed, k along the propagation of light, with
// Q = |E_x|^2 - |E_y|^2 and U = 2 Re(E_x E_y*). They differ in two points:
//
//   solver (optics/stokes.h):  x = e_theta, y = e_phi about the outward normal; V = -2 Im(E_x E_y*) for exp(-i w t),
//                              V > 0 left circular, the field turns counter-clockwise for who looks into the source.
//   renderer (Mitsuba 3):      x free, kept with each matrix and each path; V = +2 Im(E_x E_y*) for exp(-i w t),
//                              V > 0 right circular, clockwise for who looks into the source.
//
// So the bridge is: rows and columns of V change their sign, and the solver's matrices act between the frames whose x
// is e_theta. tests: stokes_frames_test.cpp (dipole scattering and Fresnel reflection from explicit electric fields).

#include "patina/optics/stokes.h"
#include "patina/render/vec.h"

namespace patina::render {

// A Mueller matrix of the solver in the renderer's signs, still between meridian frames.
inline optics::Mueller from_solver(const optics::Mueller& m) {
    const Eigen::Vector4d flip(1, 1, 1, -1);
    return flip.asDiagonal() * m * flip.asDiagonal();
}

// x of the solver's frame for light that travels along k: e_theta = d k / d theta about the axis z (the outward
// normal). At the poles the meridian plane is that of azimuth 0.
inline Vec3 meridian_axis(const Vec3& k) {
    const float sin_theta = std::hypot(k.x(), k.y());
    if (sin_theta < 1e-7f) return {k.z() > 0 ? 1.0f : -1.0f, 0, 0};
    return {k.z() * k.x() / sin_theta, k.z() * k.y() / sin_theta, -sin_theta};
}

// cos and sin of twice the angle that turns x_from into x_to, counter-clockwise about the propagation direction k, that
// is for who looks into the source.
struct DoubleAngle {
    float cos = 1, sin = 0;
};
inline DoubleAngle rotation_between(const Vec3& k, const Vec3& x_from, const Vec3& x_to) {
    const float c = x_from.dot(x_to), s = k.cross(x_from).dot(x_to);
    return {c * c - s * s, 2 * s * c};
}

// The same light seen in a frame turned by the angle: Q' = Q cos + U sin, U' = -Q sin + U cos (Collett 1992, eq. 5-43).
inline optics::Mueller rotator(DoubleAngle angle) {
    optics::Mueller m = optics::Mueller::Identity();
    m(1, 1) = m(2, 2) = angle.cos;
    m(1, 2) = angle.sin;
    m(2, 1) = -angle.sin;
    return m;
}

// M given between frames with x axes in_from, out_from, for light in along k_in and out along k_out, referred to
// others.
inline optics::Mueller rotate_frames(const optics::Mueller& m, const Vec3& k_in, const Vec3& in_from, const Vec3& in_to,
                                     const Vec3& k_out, const Vec3& out_from, const Vec3& out_to) {
    return rotator(rotation_between(k_out, out_from, out_to)) * m * rotator(rotation_between(k_in, in_to, in_from));
}

}  // namespace patina::render
