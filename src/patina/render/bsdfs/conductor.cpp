#include "patina/render/bsdfs/conductor.h"

#include "patina/render/indices.h"

namespace patina::render {

PluginDescriptor Conductor::describe() {
    return {
        "bsdf",
        "conductor",
        "Smooth metal with a complex index; polarizes and retards.",
        {{"material", "string", "", "Cu", "", "built-in material or n,k file; \"none\" is a perfect mirror"},
         {"eta", "spectrum", "", "", "0 .. 1e6", "real part of the index, instead of a material"},
         {"k", "spectrum", "", "", "0 .. 1e6", "imaginary part of the index, instead of a material"},
         {"specular_reflectance", "spectrum or texture", "", "1", "0 .. 1", "factor on reflection (not physical)"}}};
}

Conductor Conductor::build(const Properties& node, const BsdfBuilder& builder) {
    const ConductorIndex index = conductor_index(node, builder);
    return {index.n, index.k, Texture::reflectance(node, "specular_reflectance", 1.0f, *builder.resources)};
}

}  // namespace patina::render
