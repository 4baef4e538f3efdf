#include "patina/rt/monte_carlo/interface.h"

namespace patina::rt::monte_carlo {

InterfaceGains dielectric_interface(double cos_i, double n1, double n2) {
    if (n1 == n2) return {{}, {1.0, 1.0, 1.0}, cos_i};
    const double ratio = n1 / n2;
    const double cos2_t = 1.0 - ratio * ratio * (1.0 - cos_i * cos_i);

    // Beyond the critical angle both amplitudes have modulus one and only their phases differ.
    if (cos2_t <= 0.0) {
        const Complex decay(0.0, std::sqrt(-cos2_t));
        const Complex rp = (n2 * cos_i - n1 * decay) / (n2 * cos_i + n1 * decay);
        const Complex rs = (n1 * cos_i - n2 * decay) / (n1 * cos_i + n2 * decay);
        return {{1.0, 1.0, rp * std::conj(rs)}, {}, 0.0};
    }

    // Refract; the factor n2 c2 / (n1 c1) turns squared fields into flux.
    const double cos_t = std::sqrt(cos2_t);
    const double p = n2 * cos_i + n1 * cos_t, s = n1 * cos_i + n2 * cos_t;
    const double rp = (n2 * cos_i - n1 * cos_t) / p, rs = (n1 * cos_i - n2 * cos_t) / s;
    const double tp = 2.0 * n1 * cos_i / p, ts = 2.0 * n1 * cos_i / s;
    const double flux = n2 * cos_t / (n1 * cos_i);
    return {{rp * rp, rs * rs, rp * rs}, {flux * tp * tp, flux * ts * ts, flux * tp * ts}, cos_t};
}

Gain metal_mirror(double cos_i, double n1, Complex n2) {
    // The wave in the metal decays away from the surface: Im(n2 c2) >= 0.
    const Complex ratio = n1 / n2;
    Complex cos_t = std::sqrt(1.0 - ratio * ratio * (1.0 - cos_i * cos_i));
    if ((n2 * cos_t).imag() < 0.0) cos_t = -cos_t;
    const Complex rp = (n2 * cos_i - n1 * cos_t) / (n2 * cos_i + n1 * cos_t);
    const Complex rs = (n1 * cos_i - n2 * cos_t) / (n1 * cos_i + n2 * cos_t);
    return Gain::of(rp, rs);
}

}  // namespace patina::rt::monte_carlo
