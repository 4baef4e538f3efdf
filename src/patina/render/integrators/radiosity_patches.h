#pragma once
// A scene's surfaces cut into patches, for radiosity.
//
// Parallelograms are cut into equal cells, disks into rings and sectors, spheres into bands and sectors of equal area;
// a triangle is one patch. A side that can reflect has its own patch.

#include <optional>
#include <vector>

#include "patina/render/scene.h"

namespace patina::render {

struct Patch {
    SurfacePoint centre;
    bool back = false;  // the side away from the geometric normal
    float area = 0;
    int primitive = 0, cell = 0;  // analytic shape and its cell, or triangle
    bool triangle = false;
};

class RadiosityPatches {
  public:
    // About `wanted` patches. Throws Error(input) for a scene with surfaces that are not diffuse, and when its
    // triangles alone are more than `most`.
    RadiosityPatches(const Scene& scene, int wanted, int most);

    int count() const { return static_cast<int>(patches_.size()); }
    const Patch& operator[](int index) const { return patches_[index]; }
    // The patch that a ray along `direction` meets, -1 for the back of a one-sided surface.
    int find(const Hit& hit, const SurfacePoint& at, const Vec3& direction) const;
    // A point uniform over the patch.
    SurfacePoint sample(int patch, const Vec2& u) const;

  private:
    struct Grid {
        int rows = 1, columns = 1, first = 0;
        bool two_sided = false;
    };
    void add_cells(const Grid& grid, int shape, int primitive, bool triangle, float area);
    SurfacePoint point_of(const Patch& patch, const Vec2& u) const;

    const Scene& scene_;
    std::vector<Patch> patches_;
    std::vector<Grid> analytic_;                // [analytic shape]
    std::vector<std::vector<Grid>> triangles_;  // [mesh][triangle]
};

}  // namespace patina::render
