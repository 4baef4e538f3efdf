#pragma once
// Values of a mesh's vertices or triangles as a texture, `mesh_attribute`: linear over a triangle, or one of each.

#include "patina/core/mesh.h"
#include "patina/render/plugins.h"
#include "patina/render/scene_resources.h"
#include "patina/render/surface_uv.h"

namespace patina::render {

// Where an attribute is looked up; what a TexelGrid is to a picture.
struct MeshGrid {
    std::shared_ptr<const TriangleMesh> mesh;
    bool of_triangles = false;

    // `value(i)` of the vertices or of the triangle, of any type that can be scaled and added.
    template <class F>
    auto blend(const SurfaceUv& uv, const F& value) const {
        using Value = std::decay_t<decltype(value(std::size_t{}))>;
        const auto triangle = static_cast<std::size_t>(std::max(uv.triangle, 0));
        if (of_triangles) return Value(value(triangle));
        const auto& [a, b, c] = mesh->triangles[triangle];
        return Value((1 - uv.second - uv.third) * value(a) + uv.second * value(b) + uv.third * value(c));
    }
};

struct AttributePicture {
    MeshGrid grid;
    int channels = 1;
    std::vector<float> values;  // [vertex or triangle][channel], times `scale`

    std::size_t size() const { return values.size() / static_cast<std::size_t>(channels); }
    Eigen::Vector3d colour(std::size_t i) const {
        const float* p = values.data() + i * static_cast<std::size_t>(channels);
        return channels == 3 ? Eigen::Vector3d(p[0], p[1], p[2]) : Eigen::Vector3d::Constant(p[0]);
    }
};

// The attribute a <texture type="mesh_attribute"> names, of the mesh that `resources` hold. Throws Error(input) where
// there is none, and for values that are negative.
AttributePicture read_attribute(const Properties& texture, const SceneResources& resources);
PluginDescriptor attribute_descriptor();

// Does a model or a lamp ask for attributes of the mesh it is on?
bool reads_attributes(const Properties& plugin);

}  // namespace patina::render
