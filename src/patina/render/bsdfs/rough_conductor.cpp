#include "patina/render/bsdfs/rough_conductor.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/indices.h"

namespace patina::render {

Microfacets microfacets_of(const Properties& node) {
    Microfacets facets;
    const std::string kind = node.string("distribution", "beckmann");
    if (kind != "ggx" && kind != "beckmann")
        throw input_error(node.location_of("distribution"), fmt::format("unknown microfacet distribution \"{}\"", kind),
                          "", did_you_mean(kind, {"ggx", "beckmann"}));
    facets.kind = kind == "ggx" ? MicrofacetKind::ggx : MicrofacetKind::beckmann;
    const double alpha = node.number("alpha", 0.1);
    facets.alpha_x = static_cast<float>(node.number("alpha_u", alpha));
    facets.alpha_y = static_cast<float>(node.number("alpha_v", alpha));
    // Below 1e-4 a facet turns light by less than a float can tell from the mirror direction.
    for (const auto& [name, value] : {std::pair{"alpha_u", facets.alpha_x}, {"alpha_v", facets.alpha_y}})
        if (!(value >= 1e-4f && value <= 2.0f))
            throw input_error(node.location_of(node.has(name) ? name : "alpha"), "roughness out of range",
                              fmt::format("it is {}", value), "keep it between 0.0001 and 2, or use the smooth model");
    return facets;
}

PluginDescriptor RoughConductor::describe() {
    return {
        "bsdf",
        "roughconductor",
        "Rough metal: microfacets of a conductor, full Mueller matrix.",
        {{"material", "string", "", "Cu", "", "built-in material or n,k file; \"none\" is a perfect mirror"},
         {"eta", "spectrum", "", "", ">= 0", "real part of the index, instead of a material"},
         {"k", "spectrum", "", "", ">= 0", "imaginary part of the index, instead of a material"},
         {"distribution", "string", "", "beckmann", "ggx, beckmann", "distribution of facet normals"},
         {"alpha", "number", "", "0.1", "0.0001 .. 2", "roughness"},
         {"alpha_u", "number", "", "alpha", "0.0001 .. 2", "roughness along the tangent"},
         {"alpha_v", "number", "", "alpha", "0.0001 .. 2", "roughness across the tangent"},
         {"sample_visible", "boolean", "", "true", "true", "visible normals are always sampled"},
         {"specular_reflectance", "spectrum or texture", "", "1", "0 .. 1", "factor on reflection (not physical)"}}};
}

RoughConductor RoughConductor::build(const Properties& node, const BsdfBuilder& builder) {
    const ConductorIndex index = conductor_index(node, builder);
    node.boolean("sample_visible", true);
    return {index.n, index.k, microfacets_of(node),
            Texture::reflectance(node, "specular_reflectance", 1.0f, *builder.resources)};
}

}  // namespace patina::render
