#pragma once
// Lambertian reflection, `diffuse`: f = reflectance / pi on the side of the normal, depolarizing; nothing on the other.

#include "patina/render/bsdf.h"
#include "patina/render/sampling.h"
#include "patina/render/texture.h"

namespace patina::render {

struct Diffuse {
    Texture reflectance;

    bool is_delta(const ShadingPoint&) const { return false; }

    bool sample(const ShadingPoint& point, const Vec3& outgoing, float, const Vec2& u, BsdfSample& sample) const {
        if (outgoing.z() <= 0) return false;
        sample.incident = cosine_hemisphere(u);
        sample.pdf = sample.incident.z() * inv_pi_f;
        sample.weight.set_depolarizing(reflectance.at(*point.wavelengths, point.uv));
        return sample.pdf > 0;
    }
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const {
        if (outgoing.z() <= 0 || incident.z() <= 0) return false;
        value.pdf = incident.z() * inv_pi_f;
        value.f.set_depolarizing(reflectance.at(*point.wavelengths, point.uv) * value.pdf);
        return true;
    }

    static PluginDescriptor describe();
    static Diffuse build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
