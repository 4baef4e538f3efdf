#pragma once
// A coating, `paint`: the body (subsurface) part of a Mueller BRDF table and its mirror part, as the solver computed
// them.
//
// The body is read from a compact table (paint_table.h), linear between nodes: about 2e-3 of the intensity. The mirror
// part (surface, and the coherent beam from a metal base) is a delta function with a Fresnel-like matrix. Black from
// behind: the table describes the side of the normal.

#include "patina/render/bsdf.h"
#include "patina/render/paint_table.h"

namespace patina::render {

struct Paint {
    std::shared_ptr<const PaintTable> table;

    bool is_delta(const ShadingPoint&) const { return false; }

    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const {
        if (outgoing.z() <= 0) return false;
        const float mirror = table->specular_share(outgoing.z());
        if (u < mirror) {
            const auto [a, b, c, d] = table->specular(*point.wavelengths, outgoing.z());
            const Vec3 axis = perpendicular_to_normal(outgoing);
            sample.incident = Vec3(-outgoing.x(), -outgoing.y(), outgoing.z());
            sample.pdf = mirror;
            sample.delta = true;
            sample.weight.set_fresnel(a / mirror, b / mirror, c / mirror, d / mirror, axis, axis);
            return true;
        }
        float density = 0;
        sample.incident = table->sample(outgoing, u2, (u - mirror) / (1 - mirror), density);
        sample.pdf = density * (1 - mirror);
        if (!(sample.pdf > 0)) return false;
        table->evaluate(*point.wavelengths, outgoing, sample.incident, point.unpolarized_light, sample.weight);
        scale(sample.weight, sample.incident.z() / sample.pdf, point.unpolarized_light);
        return true;
    }
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const {
        if (outgoing.z() <= 0 || incident.z() <= 0) return false;
        table->evaluate(*point.wavelengths, outgoing, incident, point.unpolarized_light, value.f);
        scale(value.f, incident.z(), point.unpolarized_light);
        value.pdf = table->pdf(outgoing, incident) * (1 - table->specular_share(outgoing.z()));
        return true;
    }

    static PluginDescriptor describe();
    static Paint build(const Properties& node, const BsdfBuilder& builder);

  private:
    static void scale(ScatteringMatrix& matrix, float factor, bool first_column_only) {
        for (int e = 0; e < (first_column_only ? 4 : 16); ++e) matrix.m[e] *= factor;
    }
};

}  // namespace patina::render
