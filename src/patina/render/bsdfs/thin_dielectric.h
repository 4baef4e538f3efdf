#pragma once
// A thin pane of a transparent medium, `thindielectric`: all reflections between its two parallel faces added up
// without interference; light passes straight on. Polarized.
//
// With R and T of one face (Fresnel), for each of s and p: R' = R + T^2 R / (1 - R^2), T' = T^2 / (1 - R^2), and the
// same sums for the coherence of s and p, which the faces multiply by r_p r_s* and sqrt(T_s T_p) (Stokes's pile of
// plates; Born & Wolf 1999, section 1.5 for the faces). R' + T' = 1. Valid for panes many wavelengths thick and without
// absorption; the shift of the ray inside is ignored. A pane of lower index in total reflection reflects all: no
// tunnelling.

#include "patina/render/bsdf.h"
#include "patina/render/texture.h"

namespace patina::render {

struct ThinDielectric {
    Spectrum interior_index, exterior_index;
    Texture specular_reflectance, specular_transmittance;

    bool is_delta(const ShadingPoint&) const { return true; }
    bool evaluate(const ShadingPoint&, const Vec3&, const Vec3&, BsdfValue&) const { return false; }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const;

    static PluginDescriptor describe();
    static ThinDielectric build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
