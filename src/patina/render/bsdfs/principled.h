#pragma once
// `principled`, the artists' model of Burley (2012), Physically based shading at Disney, and (2015), Extending the
// Disney BRDF to a BSDF, with Mitsuba's parameters.
//
//   diffuse    (1 - metallic)(1 - spec_trans) base/pi ((1 - flatness) (Fd + Fr) + flatness Fs),   w(c) = (1 - c)^5
//                Fd = (1 - w_o/2)(1 - w_i/2),   R = 2 roughness (i.m)^2,   Fr = R (w_o + w_i + w_o w_i (R - 1))
//                Fs = 5/4 (Fs90 (1/(cos_o + cos_i) - 1/2) + 1/2),   Fs90 = prod over o, i of 1 + w (R/2 - 1)
//   sheen      (1 - metallic) sheen w(i.m) times 1, or the hue of base by sheen_tint
//   specular   F D G1(o) G1(i) / (4 cos_o cos_i), GGX of alpha = roughness^2 (over and times sqrt(1 - 0.9
//   anisotropic));
//              F = (1 - metallic)((1 - spec_tint) Fresnel + spec_tint Schlick(hue of base)) + metallic Schlick(base)
//   clearcoat  clearcoat/4 Schlick(0.04) D_1 G1 G1: D_1 with the long tails of GTR of exponent 1, alpha from 0.1 to
//              0.001 by clearcoat_gloss, G1 of GGX 0.25; as in Mitsuba without 1/(cos_o cos_i)
//   glass      (1 - metallic) spec_trans sqrt(base) times the refraction of rough_dielectric.h, and from behind, where
//              nothing else is, (1 - metallic) spec_trans times its reflection
//
// The dielectric's reflection and refraction polarize with their Fresnel matrices; the rest, whose optics nobody knows,
// depolarizes. Reciprocal, refraction after division by the square of the index. Not energy conserving:
// retro-reflection and sheen give energy at grazing angles to bright, rough surfaces; facets lose some as in
// rough_conductor.h and rough_dielectric.h. Black from behind without glass.

#include "patina/render/bsdf.h"
#include "patina/render/microfacet.h"
#include "patina/render/texture.h"

namespace patina::render {

struct Principled {
    Texture base_color;
    ScalarTexture roughness, anisotropic, metallic, spec_trans, spec_tint, sheen, sheen_tint, flatness, clearcoat,
        clearcoat_gloss;
    float eta = 1.5f;

    bool is_delta(const ShadingPoint&) const { return false; }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const;
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;

    static PluginDescriptor describe();
    static Principled build(const Properties& node, const BsdfBuilder& builder);

  private:
    // Probabilities of drawing from the facets, which reflect or refract, and from the clearcoat; the rest is the
    // cosine's.
    struct Shares {
        float specular, clearcoat;
    };
    Shares shares(const SurfaceUv& uv) const;
    Microfacets facets(const SurfaceUv& uv) const;
    float glass(const SurfaceUv& uv) const { return (1 - metallic.at(uv)) * spec_trans.at(uv); }
    bool refract(const ShadingPoint& point, const Vec3& o, const Vec3& i, float relative, bool above, const Vec3& axis,
                 BsdfValue& value) const;
    bool reflect_inside(const ShadingPoint& point, const Vec3& o, const Vec3& i, const Vec3& axis,
                        BsdfValue& value) const;
    bool reflect(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;
    Float4 body(const ShadingPoint& point, Float4 base, float cos_o, float cos_i, float cos_m) const;
    Float4 hue(const ShadingPoint& point, Float4 base) const;
};

}  // namespace patina::render
