#include "patina/render/bsdfs/dielectric.h"

#include "patina/render/indices.h"

namespace patina::render {

PluginDescriptor Dielectric::describe() {
    return {
        "bsdf",
        "dielectric",
        "Smooth interface between two transparent media; dispersive when an index names a material.",
        {{"int_ior", "number, medium, material or spectrum", "", "bk7", "0.1 .. 10",
          "index on the side the normal leaves"},
         {"ext_ior", "number, medium, material or spectrum", "", "air", "0.1 .. 10", "index on the side of the normal"},
         {"specular_reflectance", "spectrum or texture", "", "1", "0 .. 1", "factor on reflection (not physical)"},
         {"specular_transmittance", "spectrum or texture", "", "1", "0 .. 1", "factor on refraction (not physical)"}}};
}

Dielectric Dielectric::build(const Properties& node, const BsdfBuilder& builder) {
    Dielectric d;
    d.interior_index = real_index(node, "int_ior", "bk7", builder);
    d.exterior_index = real_index(node, "ext_ior", "air", builder);
    d.specular_reflectance = Texture::reflectance(node, "specular_reflectance", 1.0f, *builder.resources);
    d.specular_transmittance = Texture::reflectance(node, "specular_transmittance", 1.0f, *builder.resources);
    d.dispersive = !d.interior_index.is_uniform() || !d.exterior_index.is_uniform();
    return d;
}

}  // namespace patina::render
