#pragma once
// Adding scattering matrices of one pair of directions, whatever form they have and whatever frames they name.

#include "patina/render/mueller_packet.h"

namespace patina::render {

// The same matrix written out in full, its axes kept (a depolarizer has none: the caller supplies them).
inline void to_general(ScatteringMatrix& m) {
    using Form = ScatteringMatrix::Form;
    if (m.form == Form::general) return;
    const bool fresnel = m.form == Form::fresnel;
    const Float4 a = m.m[0], b = m.m[1], c = m.m[2], d = m.m[3];
    m.form = Form::general;
    for (Float4& entry : m.m) entry = splat(0);
    m.m[0] = a;
    if (!fresnel) return;
    m.m[1] = m.m[4] = b;
    m.m[5] = a;
    m.m[10] = m.m[15] = c;
    m.m[11] = -d;  // row 3, column 2
    m.m[14] = d;   // row 2, column 3
}

// Refers a general matrix to other x axes (rotate_frames of stokes_frames.h, four wavelengths at once).
inline void refer_to(ScatteringMatrix& m, const Vec3& x_in, const Vec3& x_out, const Vec3& outgoing,
                     const Vec3& incident) {
    const DoubleAngle in = rotation_between(-incident, x_in, m.x_in), out = rotation_between(outgoing, m.x_out, x_out);
    for (int row = 0; row < 4; ++row) {
        const Float4 q = m.m[4 + row], u = m.m[8 + row];
        m.m[4 + row] = q * in.cos - u * in.sin;
        m.m[8 + row] = q * in.sin + u * in.cos;
    }
    for (int column = 0; column < 4; ++column) {
        const Float4 q = m.m[4 * column + 1], u = m.m[4 * column + 2];
        m.m[4 * column + 1] = q * out.cos + u * out.sin;
        m.m[4 * column + 2] = u * out.cos - q * out.sin;
    }
    m.x_in = x_in, m.x_out = x_out;
}

// sum += part, in the frames of `sum` where it has any.
inline void add_to(ScatteringMatrix& sum, ScatteringMatrix part, const Vec3& outgoing, const Vec3& incident) {
    using Form = ScatteringMatrix::Form;
    if (part.form == Form::depolarizing) {
        if (sum.form != Form::depolarizing) to_general(sum);
        sum.m[0] += part.m[0];
        return;
    }
    to_general(part);
    if (sum.form == Form::depolarizing) {
        part.m[0] += sum.m[0];
        sum = part;
        return;
    }
    to_general(sum);
    refer_to(part, sum.x_in, sum.x_out, outgoing, incident);
    for (int e = 0; e < 16; ++e) sum.m[e] += part.m[e];
}

}  // namespace patina::render
