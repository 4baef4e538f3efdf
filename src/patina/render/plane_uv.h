#pragma once
// Texture coordinates of rectangles and disks, as Mitsuba has them: of a disk the distance from the centre, and the
// azimuth from the x axis in turns.

#include "patina/render/shapes.h"

namespace patina::render {

// At a, b in -1 .. 1 along the shape's half axes.
inline Vec2 uv_of_plane(const AnalyticShape& shape, float a, float b) {
    if (shape.kind != AnalyticShape::Kind::disk) return {0.5f * (a + 1), 0.5f * (b + 1)};
    const float turns = std::atan2(b, a) * (0.5f * inv_pi_f);
    return {std::sqrt(a * a + b * b), turns < 0 ? turns + 1 : turns};
}

}  // namespace patina::render
