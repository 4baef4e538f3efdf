#pragma once
// The modified Phong model, `phong`: a Lambertian part and a cosine lobe about the mirror direction; depolarizing.
//
//   f = rho_d / pi + rho_s (n + 2) / (2 pi) cos^n(angle between i and the mirror direction of o)
//
// Lafortune & Willems (1994), Using the modified Phong reflectance model for physically based rendering, eq. 4:
// reciprocal, and rho_d + rho_s <= 1 keeps it from giving energy. The lobe reflects rho_s at normal incidence and about
// rho_s cos(theta) elsewhere (0.87, 0.50, 0.12 of rho_s at 30, 60, 85 degrees for n = 30): darker towards grazing,
// where real surfaces shine. An empirical shape: no Fresnel effect, no polarization. Black from behind.

#include "patina/render/bsdf.h"
#include "patina/render/texture.h"

namespace patina::render {

struct Phong {
    Texture diffuse_reflectance, specular_reflectance;
    float exponent = 30, specular_share = 0.5f;

    bool is_delta(const ShadingPoint&) const { return false; }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const;
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;

    static PluginDescriptor describe();
    static Phong build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
