#include "patina/render/bsdfs/rough_conductor.h"

#include "patina/render/indices.h"

namespace patina::render {

PluginDescriptor RoughConductor::describe() {
    PluginDescriptor d{
        "bsdf",
        "roughconductor",
        "Rough metal: microfacets of a conductor, full Mueller matrix.",
        {{"material", "string", "", "Cu", "", "built-in material or n,k file; \"none\" is a perfect mirror"},
         {"eta", "spectrum", "", "", "0 .. 1e6", "real part of the index, instead of a material"},
         {"k", "spectrum", "", "", "0 .. 1e6", "imaginary part of the index, instead of a material"},
         {"specular_reflectance", "spectrum or texture", "", "1", "0 .. 1", "factor on reflection (not physical)"}}};
    for (ParameterDescriptor& p : microfacet_parameters()) d.parameters.push_back(std::move(p));
    return d;
}

RoughConductor RoughConductor::build(const Properties& node, const BsdfBuilder& builder) {
    const ConductorIndex index = conductor_index(node, builder);
    return {index.n, index.k, microfacets_of(node, *builder.resources),
            Texture::reflectance(node, "specular_reflectance", 1.0f, *builder.resources)};
}

}  // namespace patina::render
