#pragma once
// `blendbsdf`: f = (1 - weight) f_1 + weight f_2, two models side by side below resolution, as full Mueller matrices.
// As energy conserving and reciprocal as the two are.

#include "patina/render/bsdf.h"
#include "patina/render/texture.h"

namespace patina::render {

struct Blend {
    int first, second;
    Texture weight;

    bool is_delta(const ShadingPoint& point) const {
        return bsdf_is_delta(nested_bsdf(point, first), point) && bsdf_is_delta(nested_bsdf(point, second), point);
    }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const;
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;

    static PluginDescriptor describe();
    static Blend build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
