#include "patina/io/image_views.h"

#include <algorithm>
#include <cmath>

#include "patina/core/contract.h"

namespace patina::io {

namespace {

template <class ColorOf>
Bitmap paint(const StokesPlane& plane, const ColorOf& color) {
    Bitmap picture{"", plane.width, plane.height, {"R", "G", "B"}, {}};
    picture.data.reserve(plane.pixels.size() * 3);
    for (const Eigen::Vector4f& stokes : plane.pixels) {
        const Eigen::Vector3f rgb = stokes.allFinite() ? Eigen::Vector3f(color(stokes)) : not_a_number_color();
        picture.data.insert(picture.data.end(), rgb.data(), rgb.data() + 3);
    }
    return picture;
}

// The value below which 99.5 % of the finite absolute values lie: a few fireflies must not darken the picture.
float robust_range(std::vector<float> values) {
    std::erase_if(values, [](float value) { return !std::isfinite(value); });
    if (values.empty()) return 1.0f;
    for (float& value : values) value = std::abs(value);
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place > 0 ? *place : std::max(*std::max_element(values.begin(), values.end()), 1e-30f);
}

}  // namespace

Bitmap dolp_view(const StokesPlane& plane, ColorMap map) {
    return paint(plane, [map](const Eigen::Vector4f& stokes) { return color_of(map, dolp(stokes)); });
}

Bitmap aolp_view(const StokesPlane& plane, AolpStyle style) {
    return paint(plane, [style](const Eigen::Vector4f& stokes) {
        const float degree = dolp(stokes);
        return color_of_hsv(aolp_deg(stokes) / 180.0f, style == AolpStyle::light ? degree : 1.0f,
                            style == AolpStyle::dark ? degree : 1.0f);
    });
}

Bitmap docp_view(const StokesPlane& plane) {
    return paint(
        plane, [](const Eigen::Vector4f& stokes) { return color_of(ColorMap::diverging, 0.5f + 0.5f * docp(stokes)); });
}

Bitmap type_view(const StokesPlane& plane) {
    return paint(plane, [](const Eigen::Vector4f& stokes) {
        const float linear = std::min(dolp(stokes), 1.0f), circular = std::min(std::abs(docp(stokes)), 1.0f);
        return Eigen::Vector3f(circular, std::min(linear + circular, 1.0f), linear);
    });
}

Bitmap chirality_view(const StokesPlane& plane) {
    return paint(plane, [](const Eigen::Vector4f& stokes) {
        const float left = std::clamp(-docp(stokes), 0.0f, 1.0f), right = std::clamp(docp(stokes), 0.0f, 1.0f);
        return Eigen::Vector3f(left, left, right);
    });
}

Bitmap stokes_view(const StokesPlane& plane, int component, bool normalized, float range, float& used_range) {
    PATINA_EXPECT(component >= 0 && component < 4);
    const auto value = [&](const Eigen::Vector4f& stokes) {
        if (!normalized) return stokes[component];
        return stokes[0] > 0 ? stokes[component] / stokes[0] : 0.0f;
    };
    used_range = range;
    if (!(range > 0)) {
        std::vector<float> values;
        for (const Eigen::Vector4f& stokes : plane.pixels) values.push_back(value(stokes));
        used_range = robust_range(std::move(values));
    }
    return paint(plane, [&](const Eigen::Vector4f& stokes) {
        const float share = value(stokes) / used_range;
        return component == 0 ? color_of(ColorMap::inferno, share) : color_of(ColorMap::diverging, 0.5f + 0.5f * share);
    });
}

Bitmap share_view(const StokesImage& image, const std::vector<float>& values, float range, float& used_range) {
    PATINA_EXPECT(values.size() == image.pixel_count());
    used_range = range > 0 ? range : robust_range(values);
    Bitmap picture{"", image.width, image.height, {"R", "G", "B"}, {}};
    picture.data.reserve(values.size() * 3);
    for (const float value : values) {
        const Eigen::Vector3f rgb = color_of(ColorMap::inferno, value / used_range);
        picture.data.insert(picture.data.end(), rgb.data(), rgb.data() + 3);
    }
    return picture;
}

}  // namespace patina::io
