#include "patina/render/bsdfs/diffuse.h"

namespace patina::render {

PluginDescriptor Diffuse::describe() {
    return {"bsdf",
            "diffuse",
            "Lambertian reflection, depolarizing.",
            {{"reflectance", "spectrum or texture", "", "0.5", "0 .. 1", "share of the light that is reflected"}}};
}

Diffuse Diffuse::build(const Properties& node, const BsdfBuilder& builder) {
    return {Texture::reflectance(node, "reflectance", 0.5f, *builder.resources)};
}

}  // namespace patina::render
