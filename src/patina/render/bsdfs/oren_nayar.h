#pragma once
// A rough Lambertian surface, `orennayar`: symmetric V-grooves with Gaussian slopes, shadowing, masking and one
// interreflection; depolarizing.
//
// Oren & Nayar (1994), Generalization of Lambert's reflectance model, eqs. 27-30 (the full functional approximation,
// not the short qualitative one), with sigma the standard deviation of the facets' slope angle, alpha and beta the
// larger and the smaller polar angle:
//
//   f = rho/pi [C1 + cos(phi) C2 tan(beta) + (1 - |cos(phi)|) C3 tan((alpha + beta)/2)]
//     + 0.17 rho^2/pi sigma^2/(sigma^2 + 0.13) [1 - cos(phi) (2 beta/pi)^2]
//
// Reciprocal. A fit to an integral, not energy conserving: facets of reflectance 1 give back 0.95, 0.86 and 0.77 of
// the light at normal incidence for sigma = 20, 35 and 60 degrees, and at 86 degrees with sigma = 20 they give 1.02,
// 2 % too much. Black from behind.

#include "patina/render/bsdf.h"
#include "patina/render/texture.h"

namespace patina::render {

struct OrenNayar {
    Texture reflectance;
    float sigma2 = 0;  // rad^2

    bool is_delta(const ShadingPoint&) const { return false; }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const;
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;

    static PluginDescriptor describe();
    static OrenNayar build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
