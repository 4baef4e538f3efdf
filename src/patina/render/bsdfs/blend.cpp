#include "patina/render/bsdfs/blend.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/bsdf_set.h"
#include "patina/render/bsdfs/matrix_sum.h"

namespace patina::render {

bool Blend::sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const {
    const Float4 of_second = weight.at(*point.wavelengths, point.uv);
    const float p = mean(of_second);
    const bool take_second = u < p;
    const float probability = take_second ? p : 1 - p;
    const float rest = std::min(take_second ? u / p : (u - p) / (1 - p), 0x1.fffffep-1f);
    if (!bsdf_sample(nested_bsdf(point, take_second ? second : first), point, outgoing, rest, u2, sample)) return false;
    if (sample.delta) {
        sample.pdf *= probability;
        sample.weight.scale((take_second ? of_second : 1 - of_second) / probability);
        return true;
    }
    // Either model may have led here.
    return weigh_by_all_lobes(*this, point, outgoing, sample);
}

bool Blend::evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const {
    const Float4 of_second = weight.at(*point.wavelengths, point.uv);
    const float p = mean(of_second);
    BsdfValue other;
    const bool any_first = bsdf_evaluate(nested_bsdf(point, first), point, outgoing, incident, value);
    const bool any_second = bsdf_evaluate(nested_bsdf(point, second), point, outgoing, incident, other);
    if (any_second) other.f.scale(of_second);
    if (!any_first) {
        value.f = other.f;
        value.pdf = p * other.pdf;
        return any_second;
    }
    value.f.scale(1 - of_second);
    value.pdf *= 1 - p;
    if (any_second) {
        add_to(value.f, other.f, outgoing, incident);
        value.pdf += p * other.pdf;
    }
    return true;
}

PluginDescriptor Blend::describe() {
    return {"bsdf",
            "blendbsdf",
            "Mixture of two models.",
            {{"weight", "spectrum or texture", "", "0.5", "0 .. 1", "share of the second model"}}};
}
Blend Blend::build(const Properties& node, const BsdfBuilder& builder) {
    const auto models = node.children_of("bsdf");
    if (models.size() != 2)
        throw input_error(node.where, "blendbsdf takes two models", fmt::format("{} are given", models.size()));
    return {builder.nested(models.front()), builder.nested(models.back()),
            Texture::reflectance(node, "weight", 0.5f, *builder.resources)};
}

}  // namespace patina::render
