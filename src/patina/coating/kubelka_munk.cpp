#include "patina/coating/kubelka_munk.h"

#include <cmath>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/math/quadrature.h"
#include "patina/optics/fresnel.h"

namespace patina::coating {

namespace {

// Kubelka's a = 1 + K/S and b = sqrt(a^2 - 1); a - 1 is kept apart, for it vanishes without absorption.
struct Hyperbolic {
    double a_minus_one, b;
};

Hyperbolic of_ratio(double k_over_s) {
    return {k_over_s, std::sqrt(k_over_s * (k_over_s + 2.0))};
}

Hyperbolic of_reflectivity(double r) {
    return {(1.0 - r) * (1.0 - r) / (2.0 * r), (1.0 - r) * (1.0 + r) / (2.0 * r)};
}

// tanh(b x)/b, which is x without absorption.
double tanh_over(double b, double x) {
    const double z = b * x;
    return std::abs(z) < 1e-4 ? x * (1.0 - z * z / 3.0) : std::tanh(z) / b;
}

double atanh_over(double b, double x) {
    const double z = b * x;
    return std::abs(z) < 1e-4 ? x * (1.0 + z * z / 3.0) : std::atanh(z) / b;
}

}  // namespace

double kubelka_munk_reflectivity(const KubelkaMunk& coefficients) {
    PATINA_EXPECT(coefficients.k >= 0.0 && coefficients.s > 0.0);
    const Hyperbolic h = of_ratio(coefficients.k / coefficients.s);
    return 1.0 / (1.0 + h.a_minus_one + h.b);
}

double kubelka_munk_reflectance(const KubelkaMunk& coefficients, double thickness, double background) {
    PATINA_EXPECT(coefficients.k >= 0.0 && coefficients.s > 0.0 && thickness >= 0.0);
    const Hyperbolic h = of_ratio(coefficients.k / coefficients.s);
    const double a = 1.0 + h.a_minus_one;
    // Kubelka 1948, R = (1 - Rg (a - b coth bSd)) / (a - Rg + b coth bSd), times tanh(bSd)/b above and below.
    const double t = tanh_over(h.b, coefficients.s * thickness);
    return (background + t * (1.0 - a * background)) / (1.0 + t * (a - background));
}

double kubelka_munk_scattering_power(double over_black, double reflectivity) {
    PATINA_EXPECT(over_black >= 0.0 && over_black < reflectivity && reflectivity <= 1.0);
    const Hyperbolic h = of_reflectivity(reflectivity);
    // R0 = t / (1 + a t) with t = tanh(bSd)/b.
    const double t = over_black / (1.0 - (1.0 + h.a_minus_one) * over_black);
    return atanh_over(h.b, t);
}

std::optional<KubelkaMunk> kubelka_munk_from(double over_black, double reflectivity, double thickness) {
    if (!(over_black > 0.0 && over_black < reflectivity && reflectivity <= 1.0 && thickness > 0.0)) return std::nullopt;
    const double s = kubelka_munk_scattering_power(over_black, reflectivity) / thickness;
    return KubelkaMunk{s * of_reflectivity(reflectivity).a_minus_one, s};
}

double diffuse_reflection_from_outside(double refractive_index) {
    PATINA_EXPECT(refractive_index >= 1.0);
    // Fresnel reflectance is smooth in the cosine; 64 nodes leave 1e-12.
    const math::Quadrature rule = math::gauss_legendre(64, 0.0, 1.0);
    double sum = 0.0;
    for (int i = 0; i < rule.size(); ++i)
        sum += 2.0 * rule.nodes[i] * rule.weights[i] *
               optics::fresnel_reflection(rule.nodes[i], 1.0, refractive_index)(0, 0);
    return sum;
}

double diffuse_reflection_from_inside(double refractive_index) {
    // What leaves through the cone of total reflection is what enters it, compressed by n^2 (Helmholtz reciprocity).
    return 1.0 - (1.0 - diffuse_reflection_from_outside(refractive_index)) / (refractive_index * refractive_index);
}

SurfaceReflection surface_reflection(double refractive_index, double theta_deg) {
    return {optics::fresnel_reflection(std::cos(radians(theta_deg)), 1.0, refractive_index)(0, 0),
            diffuse_reflection_from_inside(refractive_index)};
}

double saunderson_from_inner(double inner, const SurfaceReflection& surface) {
    return (1.0 - surface.k1) * (1.0 - surface.k2) * inner / (1.0 - surface.k2 * inner);
}

double saunderson_to_inner(double without_specular, const SurfaceReflection& surface) {
    return without_specular / ((1.0 - surface.k1) * (1.0 - surface.k2) + surface.k2 * without_specular);
}

}  // namespace patina::coating
