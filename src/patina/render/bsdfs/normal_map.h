#pragma once
// Another model seen through the normals of a picture.
//
//   normalmap  a raw bitmap texture "normalmap": normals in tangent space, (r, g, b) = (n + 1)/2, x along u, y along v
//   bumpmap    a raw bitmap texture "bumpmap": heights, times `scale`, in units of the texture's own side: the slope
//              along u is scale dh/du. (Mitsuba's heights are in units of the scene, which is the same where one unit
//              of u spans one unit of the surface.) `mirrored` where v runs to the right of u about the normal; the
//              scene says so for the shapes that have it so
//
// The model works in a frame turned to the picture's normal; pairs of directions that lie on different sides of the two
// normals are dropped. Blinn (1978), Simulation of wrinkled surfaces, for the idea. It conserves energy: a view sees
// what the model sends it less what is dropped. It is no surface, though: no masking between wrinkles, so light is lost
// at steep normals, and it is not reciprocal (the cosine is that of the turned normal).

#include "patina/render/bsdf.h"
#include "patina/render/texel_grid.h"

namespace patina::render {

struct NormalMap {
    int model = -1;
    TexelGrid grid;
    std::vector<Vec3> normals;  // of its texels, unit, z > 0

    bool is_delta(const ShadingPoint& point) const { return bsdf_is_delta(nested_bsdf(point, model), point); }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2, BsdfSample& sample) const;
    bool evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;

    static PluginDescriptor describe();
    static NormalMap build(const Properties& node, const BsdfBuilder& builder);

  private:
    Frame frame_at(const Vec2& uv) const;
};

struct BumpMap : NormalMap {
    static PluginDescriptor describe();
    static BumpMap build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
