#pragma once
// The bridge between the solver's polarization convention and the renderer's, and rotations of Stokes frames.
//
// The renderer refers a Stokes vector to a frame (x, y, k), right-handed, k along the propagation of light; x is free
// and kept with each matrix and each path. Q = |E_x|^2 - |E_y|^2, U = 2 Re(E_x E_y*) > 0 at +45 degrees from x towards
// y, and V = 2 Im(E_x E_y*) for exp(-i w t): V > 0 is right circular, the field turns clockwise for who looks into the
// source (Mitsuba 3's convention, SPIE's).
//
// The solver refers it to p = e_theta and s = -e_phi about the outward normal (or both reversed), s x p = k, with
// U = 2 Re(E_p E_s*) and V = -2 Im(E_p E_s*) (Bohren & Huffman 1983; optics/stokes.h). With x = p that is y = -s: U
// changes its sign, and V, whose sense of rotation is the same, does not. Tests: stokes_frames_test.cpp from explicit
// fields, and against brdf/half_angle_table.h, which goes to Mitsuba's frames by another way.

#include "patina/optics/stokes.h"
#include "patina/render/vec.h"

namespace patina::render {

// A Mueller matrix of the solver in the renderer's signs, between frames whose x axes are e_theta.
inline optics::Mueller from_solver(const optics::Mueller& m) {
    const Eigen::Vector4d flip(1, 1, -1, 1);
    return flip.asDiagonal() * m * flip.asDiagonal();
}

// A Stokes vector of the solver in the renderer's signs, in the frame with x = e_theta.
inline optics::Stokes from_solver(const optics::Stokes& s) {
    return {s[0], s[1], -s[2], s[3]};
}

// e_theta = d k / d theta about the axis z (the outward normal), for light that travels along k. At the poles the
// meridian plane is that of azimuth 0.
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
