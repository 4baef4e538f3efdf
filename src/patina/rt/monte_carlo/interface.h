#pragma once
// Smooth interfaces as seen by one ray: what is reflected and refracted, by electric-field amplitudes.
//
// In the meridian frame (s horizontal, p = k x s for every ray) the amplitudes are Ep' = rp Ep, Es' = rs Es with
// rp = (n2 c1 - n1 c2)/(n2 c1 + n1 c2), rs = (n1 c1 - n2 c2)/(n1 c1 + n2 c2), c2 = +i |c2| under total reflection.

#include "patina/rt/monte_carlo/polarized_ray.h"

namespace patina::rt::monte_carlo {

// Gains of FLUX through the interface plane: reflect + transmit conserve energy.
struct InterfaceGains {
    Gain reflect, transmit;
    double cos_t = 0.0;  // in the second medium; 0 under total reflection
};

// Between transparent media, from index n1 into n2 at cos_i in (0, 1].
InterfaceGains dielectric_interface(double cos_i, double n1, double n2);

// Reflection by a smooth metal of complex index n2.
Gain metal_mirror(double cos_i, double n1, Complex n2);

// The intensity-only counterpart of a gain: mean of both polarizations, nothing couples to Q, U, V.
inline Gain unpolarized(const Gain& g) {
    const double mean = 0.5 * (g.pp + g.ss);
    return {mean, mean, 0.0};
}

}  // namespace patina::rt::monte_carlo
