#pragma once
// Plastics: a polarizing dielectric surface over a body that depolarizes. `plastic` (smooth), `roughplastic`,
// `pplastic`.
//
//   body      f = k rho / pi * t(o) t(i)^T,  t = (T_s + T_p, T_s - T_p, 0, 0)^T / 2 of the flat surface, x across the
//             plane of incidence: light is polarized by going in and by coming out, and forgets all between
//             (Baek, Jeon, Tong & Kim 2018, Simultaneous acquisition of polarimetric SVBRDF and normals, eq. 5)
//   surface   a Fresnel mirror (plastic), or microfacets as in rough_conductor.h with a dielectric's Fresnel matrix
//
// plastic, roughplastic: k = 1 / (eta^2 (1 - r F)), F the share of diffuse light that the surface sends back into the
// body and r = rho if `nonlinear`, else 1 (Mitsuba's choice; with it a white body loses nothing). pplastic: k = 1, as
// Baek et al. fit it: light sent back inside is lost.
//
// Limits: the body sees a flat surface even under microfacets, so a rough white plastic loses, and near normal
// incidence gains, some thousandths; facets scatter once. The index may depend on wavelength, for intensity only: the
// directions do not. Black from behind.

#include <optional>

#include "patina/render/bsdf.h"
#include "patina/render/microfacet.h"
#include "patina/render/texture.h"

namespace patina::render {

// Share of diffuse light inside a body that its surface sends back, by wavelength.
Spectrum diffuse_internal_reflectance(const Spectrum& interior_index, const Spectrum& exterior_index);

struct PlasticLayer {
    Spectrum interior_index, exterior_index;
    Spectrum returned_inside;  // F
    Texture diffuse_reflectance, specular_reflectance;
    float diffuse_average = 0, specular_average = 0;
    std::optional<MicrofacetField> roughness;  // none: a mirror
    bool nonlinear = false;
    bool internal_reflections = true;

    bool is_delta(const ShadingPoint&) const { return !roughness && diffuse_reflectance.is_black(); }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const;
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;

  protected:
    static PlasticLayer common(const Properties& node, const BsdfBuilder& builder, const char* interior);

    // Probability of choosing the surface, whose reflectance this is.
    float specular_share(Float4 reflectance) const;

  private:
    void add_body(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, Float4 eta,
                  ScatteringMatrix& f) const;
    float add_facets(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, Float4 eta,
                     ScatteringMatrix& f) const;
};

struct Plastic : PlasticLayer {
    static PluginDescriptor describe();
    static Plastic build(const Properties& node, const BsdfBuilder& builder);
};
struct RoughPlastic : PlasticLayer {
    static PluginDescriptor describe();
    static RoughPlastic build(const Properties& node, const BsdfBuilder& builder);
};
struct PolarizedPlastic : PlasticLayer {
    static PluginDescriptor describe();
    static PolarizedPlastic build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
