#pragma once
// Maps from the unit square to the distributions everything else is built from, and tabulated distributions.

#include <span>
#include <vector>

#include "patina/render/vec.h"

namespace patina::render {

// cos and sin of an angle up to pi / 4, by their series: to 3e-7 and 4e-8.
inline Vec2 small_angle(float angle) {
    const float a2 = angle * angle;
    const float cos = 1 + a2 * (-1 / 2.0f + a2 * (1 / 24.0f + a2 * (-1 / 720.0f + a2 * (1 / 40320.0f))));
    const float sin = angle * (1 + a2 * (-1 / 6.0f + a2 * (1 / 120.0f + a2 * (-1 / 5040.0f))));
    return {cos, sin};
}

// Uniform on the unit disk, concentric (Shirley & Chiu 1997).
inline Vec2 concentric_disk(const Vec2& u) {
    const float a = 2 * u.x() - 1, b = 2 * u.y() - 1;
    if (a == 0 && b == 0) return Vec2::Zero();
    const bool first = std::abs(a) > std::abs(b);
    const float r = first ? a : b, other = first ? b : a;
    // The angle from the nearer axis lies within pi / 4.
    const Vec2 turn = small_angle(0.25f * pi_f * (other / r));
    return first ? Vec2(r * turn.x(), r * turn.y()) : Vec2(r * turn.y(), r * turn.x());
}

// Density cos / pi on the upper hemisphere (Malley's method).
inline Vec3 cosine_hemisphere(const Vec2& u) {
    const Vec2 d = concentric_disk(u);
    return {d.x(), d.y(), safe_sqrt(1 - d.squaredNorm())};
}

inline Vec3 uniform_sphere(const Vec2& u) {
    const float z = 1 - 2 * u.x(), r = safe_sqrt(1 - z * z), phi = 2 * pi_f * u.y();
    return {r * std::cos(phi), r * std::sin(phi), z};
}

// Share of the first technique in a mix of two, power heuristic with exponent 2 (Veach 1997, section 9.2.4).
inline float power_heuristic(float first_pdf, float second_pdf) {
    const float ratio = second_pdf / first_pdf;
    return 1 / (1 + ratio * ratio);
}

// A discrete distribution over weights >= 0, not all 0.
class DiscreteDistribution {
  public:
    DiscreteDistribution() = default;
    explicit DiscreteDistribution(std::span<const double> weights);

    struct Choice {
        int index;
        float probability;
        float remainder;  // u, made uniform again within the choice
    };
    Choice sample(float u) const;
    float probability(int index) const { return cumulative_[index + 1] - cumulative_[index]; }
    int size() const { return static_cast<int>(cumulative_.size()) - 1; }
    double total() const { return total_; }

  private:
    std::vector<float> cumulative_;  // [size + 1], 0 .. 1
    double total_ = 0;
};

}  // namespace patina::render
