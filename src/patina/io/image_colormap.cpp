#include "patina/io/image_colormap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "patina/spectral/colorimetry.h"

namespace patina::io {

namespace {

using Anchor = std::array<unsigned char, 3>;

// Every eighth of matplotlib's tables, which are in the public domain (CC0).
constexpr std::array<Anchor, 9> viridis{{{68, 1, 84},
                                         {71, 44, 122},
                                         {59, 81, 139},
                                         {44, 113, 142},
                                         {33, 144, 141},
                                         {39, 173, 129},
                                         {92, 200, 99},
                                         {170, 220, 50},
                                         {253, 231, 37}}};
constexpr std::array<Anchor, 9> inferno{{{0, 0, 4},
                                         {31, 12, 72},
                                         {85, 15, 109},
                                         {136, 34, 106},
                                         {186, 54, 85},
                                         {227, 89, 51},
                                         {249, 140, 10},
                                         {249, 201, 50},
                                         {252, 255, 164}}};
// Moreland's (2009) cool to warm at its quarters.
constexpr std::array<Anchor, 5> diverging{
    {{59, 76, 192}, {141, 176, 254}, {221, 221, 221}, {244, 154, 123}, {180, 4, 38}}};
constexpr std::array<Anchor, 2> grey{{{0, 0, 0}, {255, 255, 255}}};

std::span<const Anchor> anchors(ColorMap map) {
    switch (map) {
        case ColorMap::viridis:
            return viridis;
        case ColorMap::inferno:
            return inferno;
        case ColorMap::diverging:
            return diverging;
        case ColorMap::grey:
            break;
    }
    return grey;
}

}  // namespace

Eigen::Vector3f linear_color(const Eigen::Vector3f& encoded) {
    return encoded.unaryExpr([](float value) { return static_cast<float>(spectral::srgb_decode(value)); });
}

Eigen::Vector3f color_of(ColorMap map, float position) {
    if (std::isnan(position)) return not_a_number_color();
    const std::span<const Anchor> table = anchors(map);
    const float place = std::clamp(position, 0.0f, 1.0f) * static_cast<float>(table.size() - 1);
    const std::size_t left = std::min(static_cast<std::size_t>(place), table.size() - 2);
    const float share = place - static_cast<float>(left);
    Eigen::Vector3f encoded;
    for (int c = 0; c < 3; ++c) encoded[c] = ((1 - share) * table[left][c] + share * table[left + 1][c]) / 255.0f;
    return linear_color(encoded);
}

Eigen::Vector3f color_of_hsv(float hue, float saturation, float value) {
    if (std::isnan(hue) || std::isnan(saturation) || std::isnan(value)) return not_a_number_color();
    const float s = std::clamp(saturation, 0.0f, 1.0f), v = std::clamp(value, 0.0f, 1.0f);
    const float turns = hue - std::floor(hue);
    Eigen::Vector3f encoded;
    for (int c = 0; c < 3; ++c) {
        // Each primary is full within a sixth of a turn of its hue and falls off over the next sixth.
        const float sixths =
            std::abs(std::fmod(turns * 6.0f + 6.0f - 2.0f * static_cast<float>(c) + 3.0f, 6.0f) - 3.0f);
        encoded[c] = v * (1.0f - s * (1.0f - std::clamp(2.0f - sixths, 0.0f, 1.0f)));
    }
    return linear_color(encoded);
}

}  // namespace patina::io
