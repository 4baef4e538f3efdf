#include "patina/render/mesh_attribute.h"

#include <algorithm>

#include <fmt/format.h>

#include "patina/core/error.h"

namespace patina::render {

AttributePicture read_attribute(const Properties& texture, const SceneResources& resources) {
    expect_plugin(texture);
    const std::string name = texture.string("name");
    const SourceLocation where = texture.location_of("name");
    if (!resources.mesh)
        throw input_error(where, fmt::format("there is no \"{}\" here", name), "only meshes have attributes",
                          "use the model on a \"ply\" or \"obj\"");
    const auto& all = resources.mesh->attributes;
    const auto found = std::ranges::find(all, name, &MeshAttribute::name);
    if (found == all.end()) {
        std::vector<std::string> names;
        for (const MeshAttribute& attribute : all) names.push_back(attribute.name);
        throw input_error(where, fmt::format("mesh \"{}\" has no attribute \"{}\"", resources.mesh->name, name),
                          names.empty() ? "it has none at all" : "", did_you_mean(name, names));
    }
    const double scale = texture.number("scale", 1.0);
    if (!(scale >= 0) || !(scale < 1e6))
        throw input_error(texture.location_of("scale"), "scale out of range", fmt::format("it is {}", scale),
                          "keep it between 0 and 1e6");
    AttributePicture picture{{resources.mesh, found->of_triangles}, found->channels, found->values};
    for (std::size_t i = 0; i < picture.values.size(); ++i) {
        float& value = picture.values[i];
        value *= static_cast<float>(scale);
        if (value >= 0 && value < 1e15f) continue;
        throw input_error(
            where, fmt::format("{} {} of \"{}\" is negative or not finite", found->of_triangles ? "triangle" : "vertex",
                               i / static_cast<std::size_t>(found->channels) + 1, name));
    }
    expect_known_properties(texture);
    return picture;
}

PluginDescriptor attribute_descriptor() {
    return {"texture",
            "mesh_attribute",
            "What a mesh file gives of each vertex or face, as a reflectance, a number or a radiance.",
            {{"name", "string", "", "", "vertex_..., face_...", "of the attribute: \"vertex_color\""},
             {"scale", "number", "", "1", "0 .. 1e6", "factor on it"}}};
}

bool reads_attributes(const Properties& plugin) {
    return (plugin.category == "texture" && plugin.type == "mesh_attribute") ||
           std::ranges::any_of(plugin.children, [](const auto& child) { return reads_attributes(*child.node); });
}

}  // namespace patina::render
