#include "patina/render/bsdfs/two_sided.h"

#include <fmt/format.h>

#include "patina/core/error.h"

namespace patina::render {

PluginDescriptor TwoSided::describe() {
    return {"bsdf", "twosided", "Makes an opaque model work from both sides; takes one or two models.", {}};
}

TwoSided TwoSided::build(const Properties& node, const BsdfBuilder& builder) {
    const auto models = node.children_of("bsdf");
    if (models.empty() || models.size() > 2)
        throw input_error(node.where, "twosided takes one or two models", fmt::format("{} are given", models.size()));
    const int front = builder.nested(models.front());
    return {front, models.size() == 2 ? builder.nested(models.back()) : front};
}

}  // namespace patina::render
