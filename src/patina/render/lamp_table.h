#pragma once
// Where on a lamp whose radiance varies light is looked for: more often where it is brighter. A table over the unit
// square from which points of the shape are drawn (Geometry::sample_shape), whose cells hold the mean radiance of what
// they map to; a tenth is drawn uniformly, so that what the table overlooks is found all the same.

#include <memory>
#include <vector>

#include "patina/render/geometry.h"
#include "patina/render/texture.h"

namespace patina::render {

class LampTable {
  public:
    // Null where it would be of no use: for one radiance everywhere, and for cubes and spheres.
    static std::shared_ptr<const LampTable> of(const Geometry& geometry, int shape, const Texture& radiance);

    // Uniform numbers as those to draw a point of the shape with, and their density (1 of uniform numbers).
    Vec2 sample(const Vec2& u, float& density) const;
    // The density with which sample() leads to a place of the shape.
    float density(const SurfaceUv& uv) const;

  private:
    Vec2 square_of(const SurfaceUv& uv) const;

    enum class Kind { parallelogram, disk, mesh };
    Kind kind_ = Kind::parallelogram;
    std::vector<float> triangle_end_;  // of a mesh: cumulative share of the area, after each triangle
    int columns_ = 0, rows_ = 0;
    DiscreteDistribution by_column_;
    std::vector<DiscreteDistribution> by_row_;  // of each column
};

}  // namespace patina::render
