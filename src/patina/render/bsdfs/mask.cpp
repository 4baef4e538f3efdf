#include "patina/render/bsdfs/mask.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/bsdf_set.h"

namespace patina::render {

void Null::pass_through(const Vec3& outgoing, float probability, Float4 transmitted, BsdfSample& sample) {
    const Vec3 axis = perpendicular_to_normal(outgoing);
    const Float4 t = transmitted / probability;
    sample.incident = -outgoing;
    sample.pdf = probability;
    sample.delta = true;
    sample.weight.set_fresnel(t, splat(0), t, splat(0), axis, axis);
}

bool Mask::sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const {
    const Float4 covered = opacity.at(*point.wavelengths, point.uv);
    const float share = mean(covered);
    if (u >= share) {
        Null::pass_through(outgoing, 1 - share, 1 - covered, sample);
        return true;
    }
    if (!bsdf_sample(nested_bsdf(point, model), point, outgoing, u / share, u2, sample)) return false;
    sample.pdf *= share;
    sample.weight.scale(covered / share);
    return true;
}

bool Mask::evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const {
    if (!bsdf_evaluate(nested_bsdf(point, model), point, outgoing, incident, value)) return false;
    const Float4 covered = opacity.at(*point.wavelengths, point.uv);
    value.pdf *= mean(covered);
    value.f.scale(covered);
    return true;
}

PluginDescriptor Null::describe() {
    return {"bsdf", "null", "Nothing: light passes straight through.", {}};
}
Null Null::build(const Properties&, const BsdfBuilder&) {
    return {};
}

PluginDescriptor Mask::describe() {
    return {"bsdf",
            "mask",
            "Holes in another model; takes one model.",
            {{"opacity", "spectrum or texture", "", "0.5", "0 .. 1", "share of the surface that is there"}}};
}
Mask Mask::build(const Properties& node, const BsdfBuilder& builder) {
    const auto models = node.children_of("bsdf");
    if (models.size() != 1)
        throw input_error(node.where, "mask takes one model", fmt::format("{} are given", models.size()));
    return {builder.nested(models.front()), Texture::reflectance(node, "opacity", 0.5f, *builder.resources)};
}

}  // namespace patina::render
