#pragma once
// `twosided`: a model for the front and one (the same by default) for the back, seen there through a half turn about
// the tangent. A turn, not a mirror image: handedness, and with it U and V, stays.

#include "patina/render/bsdf.h"

namespace patina::render {

struct TwoSided {
    int front, back;

    bool is_delta(const ShadingPoint& point) const {
        return bsdf_is_delta(nested_bsdf(point, front), point) && bsdf_is_delta(nested_bsdf(point, back), point);
    }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const {
        if (outgoing.z() > 0) return bsdf_sample(nested_bsdf(point, front), point, outgoing, u, u2, sample);
        if (!bsdf_sample(nested_bsdf(point, back), point, turned(outgoing), u, u2, sample)) return false;
        sample.incident = turned(sample.incident);
        turn_axes(sample.weight);
        return true;
    }
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const {
        if (outgoing.z() > 0) return bsdf_evaluate(nested_bsdf(point, front), point, outgoing, incident, value);
        if (!bsdf_evaluate(nested_bsdf(point, back), point, turned(outgoing), turned(incident), value)) return false;
        turn_axes(value.f);
        return true;
    }

    static PluginDescriptor describe();
    static TwoSided build(const Properties& node, const BsdfBuilder& builder);

  private:
    static Vec3 turned(const Vec3& v) { return {v.x(), -v.y(), -v.z()}; }
    static void turn_axes(ScatteringMatrix& m) {
        m.x_in = turned(m.x_in);
        m.x_out = turned(m.x_out);
    }
};

}  // namespace patina::render
