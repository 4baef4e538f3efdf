#pragma once
// Light on its way from a lamp: its Stokes vectors, which scattering matrices act on in the order of travel; and the
// matrices of the reversed ray.

#include "patina/render/mueller_packet.h"

namespace patina::render {

struct LightBeam {
    StokesPacket stokes{};
    Vec3 x_axis = Vec3::Zero(), direction = Vec3::Zero();  // of its frame, and of travel

    static LightBeam unpolarized(Float4 intensity, const Vec3& direction) {
        Vec3 s, t;
        orthonormal_basis(direction, s, t);
        return {make_stokes(intensity, splat(0), splat(0), splat(0)), s, direction};
    }
    Float4 intensity() const { return stokes_row(stokes, 0); }

    // One event (world axes), after which the light travels along `outgoing`.
    void scatter(const ScatteringMatrix& event, const Vec3& outgoing) {
        const Float4 i = intensity();
        if (event.form == ScatteringMatrix::Form::depolarizing) {
            *this = unpolarized(event.m[0] * i, outgoing);
            return;
        }
        // Refer the light to the frame the event takes it in, then multiply.
        const DoubleAngle r = rotation_between(direction, x_axis, event.x_in);
        const Float4 q0 = stokes_row(stokes, 1), u0 = stokes_row(stokes, 2), v = stokes_row(stokes, 3);
        const Float4 q = q0 * r.cos + u0 * r.sin, u = u0 * r.cos - q0 * r.sin;
        const Float4* m = event.m;
        if (event.form == ScatteringMatrix::Form::fresnel)
            stokes = make_stokes(m[0] * i + m[1] * q, m[1] * i + m[0] * q, m[2] * u + m[3] * v, m[2] * v - m[3] * u);
        else
            stokes =
                make_stokes(m[0] * i + m[4] * q + m[8] * u + m[12] * v, m[1] * i + m[5] * q + m[9] * u + m[13] * v,
                            m[2] * i + m[6] * q + m[10] * u + m[14] * v, m[3] * i + m[7] * q + m[11] * u + m[15] * v);
        x_axis = event.x_out;
        direction = outgoing;
    }
};

// The matrix for light that runs the same way backwards: D M^T D, D = diag(1, 1, -1, 1), between the same x axes (de
// Hoop 1960; Hovenier 1969: y turns with the direction, and U with it). The form of Fresnel's matrices reproduces
// itself.
inline ScatteringMatrix reversed(const ScatteringMatrix& event) {
    ScatteringMatrix r = event;
    if (event.form == ScatteringMatrix::Form::depolarizing) return r;
    std::swap(r.x_in, r.x_out);
    if (event.form == ScatteringMatrix::Form::fresnel) return r;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            r.m[4 * column + row] = ((row == 2) != (column == 2) ? -1.0f : 1.0f) * event.m[4 * row + column];
    return r;
}

}  // namespace patina::render
