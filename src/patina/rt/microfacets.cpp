#include "patina/rt/microfacets.h"

#include <cmath>

#include "patina/core/constants.h"
#include "patina/math/quadrature.h"
#include "patina/optics/fresnel.h"

namespace patina::rt {

namespace {

using Eigen::Vector3d;
using optics::Mueller;

// A ray with the basis of the Stokes vectors: p in the meridian plane, s horizontal, s x p = k.
struct Frame {
    Vector3d k, p, s;
};

Frame meridian(double cos_up, double phi) {
    const double sine = std::sqrt(std::max(0.0, 1.0 - cos_up * cos_up)), c = std::cos(phi), n = std::sin(phi);
    return {{sine * c, sine * n, cos_up}, {cos_up * c, cos_up * n, -sine}, {n, -c, 0.0}};
}

// From the meridian plane into the plane whose p direction is given.
Mueller rotation(const Frame& frame, const Vector3d& p) {
    const double c = p.dot(frame.p), s = p.dot(frame.s), c2 = c * c - s * s, s2 = 2.0 * c * s;
    Mueller m;
    m << 1, 0, 0, 0, 0, c2, s2, 0, 0, -s2, c2, 0, 0, 0, 0, 1;
    return m;
}

}  // namespace

double Microfacets::density(double cos_h) const {
    const double a2 = surface_.alpha * surface_.alpha, c2 = cos_h * cos_h;
    if (surface_.distribution == FacetDistribution::ggx) {
        const double root = c2 * (a2 - 1.0) + 1.0;
        return a2 / (pi * root * root);
    }
    return std::exp(-(1.0 - c2) / (c2 * a2)) / (pi * a2 * c2 * c2);
}

// Share of the facets seen from a direction: 1/(1 + Lambda) (Heitz 2014, J. Comput. Graph. Tech. 3, 48, eqs 66, 72).
double Microfacets::shadowing(double cosine) const {
    const double c = std::abs(cosine), tangent = std::sqrt(std::max(0.0, 1.0 - c * c)) / c;
    if (tangent == 0.0) return 1.0;
    const double a = 1.0 / (surface_.alpha * tangent);
    if (surface_.distribution == FacetDistribution::ggx) return 2.0 / (1.0 + std::sqrt(1.0 + 1.0 / (a * a)));
    return 2.0 / (1.0 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(pi)));
}

optics::Mueller Microfacets::operator()(double cos_i, double cos_o, double phi, bool only_mirrors) const {
    const Frame in = meridian(cos_i, 0.0), out = meridian(cos_o, phi);
    const bool from_above = cos_i < 0.0, reflected = from_above == (cos_o > 0.0);
    const std::complex<double> n_i = from_above ? above_ : below_, n_t = from_above ? below_ : above_;

    // The facet's normal, turned upward.
    Vector3d h = reflected ? Vector3d(out.k - in.k) : Vector3d(n_t.real() * out.k - n_i.real() * in.k);
    if (!(h.norm() > 0.0)) return Mueller::Zero();
    h *= (h.z() < 0.0 ? -1.0 : 1.0) / h.norm();
    const double side_i = -in.k.dot(h), side_o = out.k.dot(h);
    // Facets are met on the side of the surface the light comes from and left on that it goes to.
    if (side_i * -in.k.z() <= 0.0 || side_o * out.k.z() <= 0.0) return Mueller::Zero();
    const double local_i = std::min(1.0, std::abs(side_i)), local_o = std::min(1.0, std::abs(side_o));

    const Vector3d across = in.k.cross(h);
    const Vector3d s = across.norm() > 1e-12 ? Vector3d(across.normalized()) : in.s;
    Mueller facet;
    if (only_mirrors) {
        facet = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
    } else if (reflected) {
        facet = optics::fresnel_reflection(local_i, n_i, n_t);
    } else {
        facet = optics::fresnel_transmission(local_i, n_i.real(), n_t.real());
    }
    facet = rotation(out, out.k.cross(s)).transpose() * facet * rotation(in, in.k.cross(s));

    const double common = density(h.z()) * shadowing(cos_i) * shadowing(cos_o) / std::abs(cos_i * cos_o);
    if (reflected) return 0.25 * common * facet;
    const double root = n_i.real() * local_i - n_t.real() * local_o;
    // |i.h||o.h| n_o^2 / (n_i i.h + n_o o.h)^2, where i.h and o.h have opposite signs; n_o^2 / (n_o/n_i).
    return common * local_i * local_o * n_i.real() * n_t.real() / (root * root) * facet;
}

// The sum over facets instead of directions: int D(h) G1(i) |i.h| / cos_i F G1(o) dh (Walter et al. 2007, eqs 18, 20).
double Microfacets::reflectance(double cos_i) const {
    static const math::Quadrature tilts = math::gauss_legendre(32, 0.0, 0.5 * pi),
                                  turns = math::gauss_legendre(32, 0.0, pi);
    const bool from_above = cos_i < 0.0;
    const std::complex<double> n_i = from_above ? above_ : below_, n_t = from_above ? below_ : above_;
    const double up = std::abs(cos_i), across = std::sqrt(std::max(0.0, 1.0 - up * up)), shadow = shadowing(cos_i) / up;
    double sum = 0.0;
    for (int r = 0; r < tilts.size(); ++r) {
        // tan^2 of the facets' tilt by its cumulative distribution u = sin^2 t; so the long tail of GGX is smooth in t.
        const double u = std::pow(std::sin(tilts.nodes[r]), 2),
                     share = std::sin(2.0 * tilts.nodes[r]) * tilts.weights[r];
        const double slope = surface_.distribution == FacetDistribution::ggx ? u / (1.0 - u) : -std::log1p(-u);
        const double cos_h = 1.0 / std::sqrt(1.0 + surface_.alpha * surface_.alpha * slope);
        const double sin_h = std::sqrt(std::max(0.0, 1.0 - cos_h * cos_h));
        for (int t = 0; t < turns.size(); ++t) {
            const double local = up * cos_h + across * sin_h * std::cos(turns.nodes[t]);
            const double out = 2.0 * local * cos_h - up;
            if (local <= 0.0 || out <= 0.0) continue;
            const double fresnel = optics::fresnel_reflection(std::min(1.0, local), n_i, n_t)(0, 0);
            sum += share * turns.weights[t] / pi * shadow * local / cos_h * fresnel * shadowing(out);
        }
    }
    return sum;
}

}  // namespace patina::rt
