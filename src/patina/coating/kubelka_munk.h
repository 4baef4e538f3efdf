#pragma once
// The two-flux theory of Kubelka and Munk, and Saunderson's correction for the surface of a film.
//
// Reflectances without further words are those of the film by itself, without its surface: diffuse light in, diffuse
// light out. Kubelka & Munk 1931, Z. Tech. Phys. 12, 593; Kubelka 1948, J. Opt. Soc. Am. 38, 448; Saunderson 1942,
// J. Opt. Soc. Am. 32, 727.

#include <optional>

namespace patina::coating {

struct KubelkaMunk {
    double k;  // absorption per length, >= 0
    double s;  // scattering per length, > 0
};

// Reflectance of an infinitely thick film: 1 + K/S - sqrt((K/S)^2 + 2 K/S).
double kubelka_munk_reflectivity(const KubelkaMunk& coefficients);

// Reflectance of a film of a thickness (in the length of K and S) over a background of a given reflectance.
double kubelka_munk_reflectance(const KubelkaMunk& coefficients, double thickness, double background);

// K and S from the reflectance over black of a film of a thickness, and the reflectance of an infinitely thick one.
// Nothing unless 0 < over_black < reflectivity <= 1: no two-flux film has such reflectances.
std::optional<KubelkaMunk> kubelka_munk_from(double over_black, double reflectivity, double thickness);

// The thickness times S at which a film of a reflectivity has the reflectance `over_black` < reflectivity over black.
double kubelka_munk_scattering_power(double over_black, double reflectivity);

// What the smooth surface of a film reflects: k1 of the light that arrives from outside in the direction of the
// instrument, k2 of the diffuse light that arrives from inside.
struct SurfaceReflection {
    double k1 = 0.0;
    double k2 = 0.0;
};

// Reflected part of diffuse light that meets a smooth surface from outside, or from inside a medium of refractive index
// n >= 1 with total reflection, by integration of Fresnel's equations; 0.596 from inside for n = 1.5 (Judd 1942).
double diffuse_reflection_from_outside(double refractive_index);
double diffuse_reflection_from_inside(double refractive_index);

// For a beam, or an observer, at an angle from the normal: 8 degrees for d:8 and 8:d instruments.
SurfaceReflection surface_reflection(double refractive_index, double theta_deg);

// Reflectance with the surface, its own specular reflection left out, of a film of the given inner reflectance R:
// (1 - k1)(1 - k2) R / (1 - k2 R); and R from it. `k1` is added when the specular part is included.
double saunderson_from_inner(double inner, const SurfaceReflection& surface);
double saunderson_to_inner(double without_specular, const SurfaceReflection& surface);

}  // namespace patina::coating
