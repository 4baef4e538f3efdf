#pragma once
// Back from the disk to the square: the inverse of concentric_disk() of sampling.h.

#include <cmath>

#include "patina/render/vec.h"

namespace patina::render {

inline Vec2 square_of_disk(const Vec2& p) {
    const bool first = std::abs(p.x()) > std::abs(p.y());
    const float along = first ? p.x() : p.y(), across = first ? p.y() : p.x();
    if (along == 0) return {0.5f, 0.5f};
    const float r = std::copysign(p.norm(), along), other = r * std::atan(across / along) * (4 * inv_pi_f);
    return 0.5f * (Vec2(first ? r : other, first ? other : r) + Vec2::Ones());
}

}  // namespace patina::render
