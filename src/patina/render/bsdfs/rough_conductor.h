#pragma once
// A rough metal, `roughconductor`: Torrance & Sparrow's (1967) microfacet model with the full Fresnel Mueller matrix.
//
//   f = M_F(cos angle to m) D(m) G(i, o) / (4 cos_i cos_o),   m = normalize(i + o)
//
// D and G as in microfacet.h. Single scattering only: energy lost between facets grows with roughness (a tenth for a
// perfect mirror of GGX alpha 0.5), so it is not energy conserving in a furnace. Black from behind.

#include "patina/render/bsdf.h"
#include "patina/render/fresnel_packet.h"
#include "patina/render/microfacet.h"
#include "patina/render/texture.h"

namespace patina::render {

struct RoughConductor {
    Spectrum n, k;
    MicrofacetField roughness;
    Texture specular_reflectance;

    bool is_delta(const ShadingPoint&) const { return false; }

    bool sample(const ShadingPoint& point, const Vec3& outgoing, float, const Vec2& u, BsdfSample& sample) const {
        if (outgoing.z() <= 0) return false;
        const Microfacets facets = roughness.at(point.uv);
        const Vec3 m = facets.sample(outgoing, u);
        const float cos_m = outgoing.dot(m);
        sample.incident = 2 * cos_m * m - outgoing;
        if (sample.incident.z() <= 0 || cos_m <= 0) return false;

        // BSDF cos_i / pdf = F G2 / G1.
        const float lambda_o = facets.lambda(outgoing), lambda_i = facets.lambda(sample.incident);
        sample.pdf = facets.density(m) / (4 * (1 + lambda_o) * outgoing.z());
        reflect(point, outgoing, sample.incident, cos_m, (1 + lambda_o) / (1 + lambda_o + lambda_i), sample.weight);
        return sample.pdf > 0;
    }
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const {
        if (outgoing.z() <= 0 || incident.z() <= 0) return false;
        const Microfacets facets = roughness.at(point.uv);
        const Vec3 m = (outgoing + incident).normalized();
        const float density = facets.density(m);
        if (density <= 0) return false;
        const float lambda_o = facets.lambda(outgoing), lambda_i = facets.lambda(incident);
        const float scale = density / (4 * outgoing.z());
        value.pdf = scale / (1 + lambda_o);
        reflect(point, outgoing, incident, std::min(1.0f, outgoing.dot(m)), scale / (1 + lambda_o + lambda_i), value.f);
        return true;
    }

    static PluginDescriptor describe();
    static RoughConductor build(const Properties& node, const BsdfBuilder& builder);

  private:
    void reflect(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, float cos_m, float factor,
                 ScatteringMatrix& matrix) const {
        const Wavelengths& w = *point.wavelengths;
        const FresnelPacket f = fresnel_conductor(cos_m, n.at(w), k.at(w));
        const Float4 scale = specular_reflectance.at(w, point.uv) * factor;
        const Vec3 axis = common_perpendicular(outgoing, incident);
        matrix.set_fresnel(f.a * scale, f.b * scale, f.c * scale, f.d * scale, axis, axis);
    }
};

}  // namespace patina::render
