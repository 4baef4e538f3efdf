#pragma once
// Where on a surface a texture is asked: texture coordinates, and on a mesh the triangle and the place in it.

#include <cstdint>

#include "patina/render/vec.h"

namespace patina::render {

struct SurfaceUv : Vec2 {
    SurfaceUv() : Vec2(Vec2::Zero()) {}
    SurfaceUv(float u, float v) : Vec2(u, v) {}
    template <class Derived>
    SurfaceUv(const Eigen::MatrixBase<Derived>& uv) : Vec2(uv) {}
    SurfaceUv(const Vec2& uv, int triangle_of_mesh, float second_weight, float third_weight)
        : Vec2(uv), triangle(triangle_of_mesh), second(second_weight), third(third_weight) {}

    std::int32_t triangle = -1;   // of the mesh, -1: of none
    float second = 0, third = 0;  // weights of its second and third corner
};

}  // namespace patina::render
