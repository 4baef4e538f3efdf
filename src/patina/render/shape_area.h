#pragma once
// Points uniform over a shape's area, for light and meters that begin on it.

#include "patina/render/geometry.h"

namespace patina::render {

// u in the unit square; `normal` is that of the shape's outside, `uv` the texture coordinates.
void point_of_shape(const Geometry& geometry, const Shape& shape, const Vec2& u, Vec3& position, Vec3& normal,
                    SurfaceUv& uv);
void point_of_shape(const Geometry& geometry, const Shape& shape, const Vec2& u, Vec3& position, Vec3& normal);

}  // namespace patina::render
