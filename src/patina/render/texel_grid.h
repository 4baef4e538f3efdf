#pragma once
// Where a picture is looked up: from texture coordinates to texels and their weights, as Mitsuba's `bitmap` has it.

#include <array>

#include "patina/core/bitmap.h"
#include "patina/core/properties.h"
#include "patina/render/scene_resources.h"
#include "patina/render/vec.h"

namespace patina::render {

struct ParameterDescriptor;

// The four texels about a place and how far it lies from the first towards the second (x) and the third (y).
struct TexelPatch {
    std::array<std::size_t, 4> texel;
    float x = 0, y = 0;

    // Bilinear; `value(texel)` of any type that can be scaled and added.
    template <class F>
    auto blend(const F& value) const {
        using Value = std::decay_t<decltype(value(texel[0]))>;
        const Value below = (1 - x) * value(texel[0]) + x * value(texel[1]);
        const Value above = (1 - x) * value(texel[2]) + x * value(texel[3]);
        return Value((1 - y) * below + y * above);
    }
};

struct TexelGrid {
    enum class Wrap { repeat, mirror, clamp };  // beyond 0 .. 1
    int width = 0, height = 0;                  // row 0 at v = 0
    Wrap wrap = Wrap::repeat;
    bool nearest = false;  // one texel, instead of bilinear between texel centres
    Eigen::Matrix3f to_uv = Eigen::Matrix3f::Identity();

    TexelPatch at(const Vec2& uv) const;
    std::size_t size() const { return static_cast<std::size_t>(width) * height; }
};

// Mitsuba's `to_uv`, a 4x4 transform of which the plane part counts.
Eigen::Matrix3f plane_transform(const Properties& texture);

// The picture of a <texture type="bitmap"> and how it is looked up. `raw` is what stands for the property when the
// plugin leaves it out. Throws Error(input) for another texture, an empty picture and unknown words.
struct TexturePicture {
    std::shared_ptr<const Bitmap> image;
    TexelGrid grid;
    bool raw = false;
};
TexturePicture read_picture(const Properties& texture, const SceneResources& resources, bool raw);
std::vector<ParameterDescriptor> picture_parameters();

}  // namespace patina::render
