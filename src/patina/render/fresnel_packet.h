#pragma once
// Fresnel reflection and refraction for four wavelengths, as the renderer's block matrices.
//
// Frames: x perpendicular to the plane of incidence (s) before and after, y = k x x. Seen there the reflection matrix
// is
// [[a,b,0,0],[b,a,0,0],[0,0,c,d],[0,0,-d,c]] with a = (R_s + R_p)/2, b = (R_s - R_p)/2, c + i d = r_p r_s* for the time
// factor exp(-i w t) and n + i k: what optics::fresnel_reflection gives after the bridge of stokes_frames.h and the
// change of the axis from p to s (Mitsuba 3's mueller::specular_reflection). Test: fresnel_packet_test.cpp.

#include "patina/render/packet.h"

namespace patina::render {

struct FresnelPacket {
    Float4 a, b, c, d;
};

// Reflection at a conductor of index n + i k relative to the (transparent) medium of the incident light.
inline FresnelPacket fresnel_conductor(float cos_i, Float4 n, Float4 k) {
    const Float4 zero = splat(0);
    const float cos2 = cos_i * cos_i, sin2 = 1 - cos2;

    // The refracted wave's normal component g = n2 cos_t = g_r + i g_i, g^2 = m^2 - sin^2, in the decaying quadrant.
    const Float4 m2_r = n * n - k * k, m2_i = 2 * n * k;
    const Float4 t = m2_r - sin2;
    const Float4 norm = sqrt(t * t + m2_i * m2_i);
    const Float4 g_r = sqrt(max(0.5f * (norm + t), zero)), g_i = sqrt(max(0.5f * (norm - t), zero));

    // r_s = (cos - g) / (cos + g), numerator times the conjugate of the denominator over its norm.
    const Float4 s_den = (cos_i + g_r) * (cos_i + g_r) + g_i * g_i;
    const Float4 rs_r = (cos2 - norm) / s_den, rs_i = -2 * cos_i * g_i / s_den;

    // r_p = (m^2 cos - g) / (m^2 cos + g).
    const Float4 u_r = m2_r * cos_i, u_i = m2_i * cos_i;
    const Float4 den_r = u_r + g_r, den_i = u_i + g_i, num_r = u_r - g_r, num_i = u_i - g_i;
    const Float4 p_den = den_r * den_r + den_i * den_i + 1e-30f;
    const Float4 rp_r = (num_r * den_r + num_i * den_i) / p_den, rp_i = (num_i * den_r - num_r * den_i) / p_den;

    const Float4 r_s = rs_r * rs_r + rs_i * rs_i, r_p = rp_r * rp_r + rp_i * rp_i;
    return {0.5f * (r_s + r_p), 0.5f * (r_s - r_p), rp_r * rs_r + rp_i * rs_i, rp_i * rs_r - rp_r * rs_i};
}

// Both halves of a transparent interface, eta = n_transmitted / n_incident per wavelength; lanes in total reflection
// have transmission 0. The transmission matrix is for flux through the interface: a_r + a_t = 1.
struct FresnelInterface {
    FresnelPacket reflection, transmission;
    Float4 cos_t;
};
inline FresnelInterface fresnel_dielectric(float cos_i, Float4 eta) {
    const Float4 zero = splat(0);
    const float sin2 = 1 - cos_i * cos_i;
    const Float4 g2 = eta * eta - sin2;  // (eta cos_t)^2
    const Mask4 total = g2 <= zero;
    const Float4 g = sqrt(max(g2, zero));

    const Float4 es = cos_i + g, ep = eta * eta * cos_i + g;
    const Float4 rs = (cos_i - g) / (es + 1e-30f), rp = (eta * eta * cos_i - g) / (ep + 1e-30f);
    const Float4 r_s = rs * rs, r_p = rp * rp;
    const Float4 ts = 1 - r_s, tp = 1 - r_p;

    FresnelInterface f;
    f.cos_t = g / eta;
    f.reflection = {0.5f * (r_s + r_p), 0.5f * (r_s - r_p), rp * rs, zero};
    f.transmission = {0.5f * (ts + tp), 0.5f * (ts - tp), sqrt(max(ts * tp, zero)), zero};

    // Total reflection turns the phase: g = i h, r_s = (cos - i h)/(cos + i h), r_p = (eta^2 cos - i h)/(eta^2 cos + i
    // h).
    if (total[0] | total[1] | total[2] | total[3]) {
        const Float4 h = sqrt(max(-g2, zero)), u = eta * eta * cos_i;
        const Float4 ns = cos_i * cos_i + h * h + 1e-30f, np = u * u + h * h + 1e-30f;
        const Float4 s_r = (cos_i * cos_i - h * h) / ns, s_i = -2 * cos_i * h / ns;
        const Float4 p_r = (u * u - h * h) / np, p_i = -2 * u * h / np;
        const Float4 one = splat(1);
        f.reflection.a = select(total, one, f.reflection.a);
        f.reflection.b = select(total, zero, f.reflection.b);
        f.reflection.c = select(total, p_r * s_r + p_i * s_i, f.reflection.c);
        f.reflection.d = select(total, p_i * s_r - p_r * s_i, zero);
        f.transmission.a = select(total, zero, f.transmission.a);
        f.transmission.b = select(total, zero, f.transmission.b);
        f.transmission.c = select(total, zero, f.transmission.c);
    }
    return f;
}

}  // namespace patina::render
