#pragma once
// Holes: `mask` lets a share 1 - opacity of the light pass straight through a model as if it were not there; `null` is
// nothing at all. Neither touches polarization. As energy conserving and reciprocal as the model inside.

#include "patina/render/bsdf.h"
#include "patina/render/texture.h"

namespace patina::render {

struct Null {
    bool is_delta(const ShadingPoint&) const { return true; }
    bool evaluate(const ShadingPoint&, const Vec3&, const Vec3&, BsdfValue&) const { return false; }
    bool sample(const ShadingPoint&, const Vec3& outgoing, float, const Vec2&, BsdfSample& sample) const {
        pass_through(outgoing, 1, splat(1), sample);
        return true;
    }
    static void pass_through(const Vec3& outgoing, float probability, Float4 transmitted, BsdfSample& sample);

    static PluginDescriptor describe();
    static Null build(const Properties& node, const BsdfBuilder& builder);
};

struct Mask {
    int model;
    Texture opacity;

    bool is_delta(const ShadingPoint& point) const { return bsdf_is_delta(nested_bsdf(point, model), point); }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const;
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;

    static PluginDescriptor describe();
    static Mask build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
