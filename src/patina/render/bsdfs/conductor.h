#pragma once
// A smooth metal, `conductor`: Fresnel reflection with a complex index, a delta function; black from behind.
//
// Born & Wolf (1999), section 14.2, for the time factor exp(-i w t) and n + i k. The outside is vacuum.

#include "patina/render/bsdf.h"
#include "patina/render/fresnel_packet.h"
#include "patina/render/texture.h"

namespace patina::render {

struct Conductor {
    Spectrum n, k;
    Texture specular_reflectance;

    bool is_delta(const ShadingPoint&) const { return true; }
    bool evaluate(const ShadingPoint&, const Vec3&, const Vec3&, BsdfValue&) const { return false; }

    bool sample(const ShadingPoint& point, const Vec3& outgoing, float, const Vec2&, BsdfSample& sample) const {
        if (outgoing.z() <= 0) return false;
        const Wavelengths& w = *point.wavelengths;
        const FresnelPacket f = fresnel_conductor(outgoing.z(), n.at(w), k.at(w));
        const Float4 scale = specular_reflectance.at(w, point.uv);
        const Vec3 axis = perpendicular_to_normal(outgoing);
        sample.incident = Vec3(-outgoing.x(), -outgoing.y(), outgoing.z());
        sample.pdf = 1;
        sample.delta = true;
        sample.weight.set_fresnel(f.a * scale, f.b * scale, f.c * scale, f.d * scale, axis, axis);
        return true;
    }

    static PluginDescriptor describe();
    static Conductor build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
