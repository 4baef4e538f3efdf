#pragma once
// Fresnel reflection and refraction at a smooth interface, complex refractive indices included.
//
// Amplitude coefficients refer to the directions p (in the plane of incidence) and s with the signs of
// docs/conventions.md: r_p = (n2 c1 - n1 c2)/(n2 c1 + n1 c2), r_s = (n1 c1 - n2 c2)/(n1 c1 + n2 c2), time factor exp(-i
// w t), c2 = +i |c2| under total reflection (Born & Wolf 1999, section 1.5). At normal incidence r_s = -r_p.

#include <complex>

#include "patina/optics/stokes.h"

namespace patina::optics {

using Complex = std::complex<double>;

struct FresnelAmplitudes {
    Complex r_p, r_s;  // reflected / incident electric field
    Complex t_p, t_s;  // transmitted / incident electric field
    Complex cos_t;     // cosine of the (complex) angle of refraction, Im(n2 cos_t) >= 0
};

// From the medium n1 (the incident side) into n2, at cos_i in [0, 1].
FresnelAmplitudes fresnel_amplitudes(double cos_i, Complex n1, Complex n2);

// Mueller matrix of reflection: flux out = M flux in, M33 = M44 = Re(r_p r_s*), M34 = Im(r_p r_s*) = -M43.
Mueller fresnel_reflection(double cos_i, Complex n1, Complex n2);

// Mueller matrix of refraction between two transparent media for the FLUX through the interface plane, so that
// reflection + transmission conserve energy. Radiance follows as M (n2/n1)^2. Zero under total reflection.
Mueller fresnel_transmission(double cos_i, double n1, double n2);

// cos of the refraction angle in n2 for real indices; 0 under total reflection.
double refracted_cosine(double cos_i, double n1, double n2);

}  // namespace patina::optics
