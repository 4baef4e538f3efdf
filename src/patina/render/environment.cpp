// The latitude-longitude environment: look-up, density and sampling.

#include <algorithm>

#include "patina/render/emitters.h"

namespace patina::render {

namespace {

Vec2 uv_of(const Vec3& local) {
    const float u = std::atan2(local.x(), -local.z()) * (0.5f * inv_pi_f);
    return {u < 0 ? u + 1 : u, std::acos(std::clamp(local.y(), -1.0f, 1.0f)) * inv_pi_f};
}

}  // namespace

Float4 EnvironmentEmitter::radiance(const Wavelengths& w, const Vec3& direction) const {
    // Bilinear between texel centres; the picture closes on itself in azimuth.
    const Vec2 uv = uv_of(to_local * direction);
    const float x = uv.x() * width - 0.5f, y = uv.y() * height - 0.5f;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const float fx = x - x0, fy = y - y0;
    const auto texel = [&](int column, int row) {
        column = (column + width) % width;
        row = std::clamp(row, 0, height - 1);
        const auto& t = texels[static_cast<std::size_t>(row) * width + column];
        return sigmoid_reflectance({t[0], t[1], t[2]}, w) * t[3];
    };
    return illuminant.at(w) * ((1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0)) +
                               fy * ((1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1)));
}

float EnvironmentEmitter::pdf(const Vec3& direction) const {
    const Vec3 local = to_local * direction;
    const Vec2 uv = uv_of(local);
    const int row = std::min(static_cast<int>(uv.y() * height), height - 1);
    const int column = std::min(static_cast<int>(uv.x() * width), width - 1);
    const float sin_theta = safe_sqrt(1 - sqr(local.y()));
    if (sin_theta <= 0) return 0;
    const float cell = 2 * pi_f * pi_f * sin_theta / (static_cast<float>(width) * height);
    return rows.probability(row) * columns[row].probability(column) / cell;
}

void EnvironmentEmitter::sample(const Vec2& u, Vec3& direction, float& density) const {
    const auto row = rows.sample(u.y());
    const auto column = columns[row.index].sample(u.x());
    const float theta = pi_f * (row.index + row.remainder) / height;
    const float phi = 2 * pi_f * (column.index + column.remainder) / width;
    const float sin_theta = std::sin(theta);
    const Vec3 local(sin_theta * std::sin(phi), std::cos(theta), -sin_theta * std::cos(phi));
    direction = to_local.transpose() * local;
    const float cell = 2 * pi_f * pi_f * sin_theta / (static_cast<float>(width) * height);
    density = sin_theta > 0 ? row.probability * column.probability / cell : 0.0f;
}

}  // namespace patina::render
