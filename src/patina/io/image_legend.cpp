#include "patina/io/image_legend.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/io/pixel_font.h"

namespace patina::io {

namespace {

constexpr int gap = 8, bar_width = 16, smallest_side = 48, lowest_bar = 16;

// The colour that a view gives to one Stokes vector.
template <class View>
Eigen::Vector3f seen(const View& view, const Eigen::Vector4f& stokes) {
    return Eigen::Map<const Eigen::Vector3f>(Bitmap(view(StokesPlane{1, 1, {stokes}})).data.data());
}

// In pixels; the lower and right bounds are outside.
struct Box {
    int left = 0, top = 0, right = 0, bottom = 0;

    void include(const Box& other) {
        left = std::min(left, other.left), top = std::min(top, other.top);
        right = std::max(right, other.right), bottom = std::max(bottom, other.bottom);
    }
};

// The upper left corner of a mark's text, from that of the key.
Box place(const Legend::Mark& mark, const PixelText& text, const Box& key, int distance) {
    const int x = key.left + static_cast<int>(std::lround(mark.u * static_cast<float>(key.right - key.left))),
              y = key.top + static_cast<int>(std::lround((1.0f - mark.v) * static_cast<float>(key.bottom - key.top)));
    const int width = text.width(), height = text.height();
    const int left = x + (mark.right - 1) * width / 2 + mark.right * distance,
              top = y - (mark.up + 1) * height / 2 - (mark.v < 0.0f || mark.v > 1.0f ? mark.up * distance : 0);
    return {left, top, left + width, top + height};
}

Bitmap widened(const Bitmap& picture, int more) {
    Bitmap wide{picture.name, picture.width + more, picture.height, picture.channels, {}};
    wide.data.assign(static_cast<std::size_t>(wide.width) * wide.height * 3, 0.0f);
    for (int y = 0; y < picture.height; ++y)
        std::copy_n(picture.data.begin() + static_cast<std::ptrdiff_t>(y) * picture.width * 3, picture.width * 3,
                    wide.data.begin() + static_cast<std::ptrdiff_t>(y) * wide.width * 3);
    return wide;
}

void draw_key(Bitmap& picture, const Box& key, const Legend& legend) {
    // Bars end with the colours of their bounds.
    const auto share = [](int i, int count) { return static_cast<float>(i) / static_cast<float>(count - 1); };
    for (int y = key.top; y < key.bottom; ++y)
        for (int x = key.left; x < key.right; ++x)
            if (const auto color = legend.color(share(x - key.left, key.right - key.left),
                                                share(key.bottom - 1 - y, key.bottom - key.top)))
                set_pixel(picture, x, y, *color);
}

}  // namespace

Legend bar_legend(const std::string& title, ColorMap map, float low, float high) {
    const auto number = [](float value) { return fmt::format("{:.3g}", value); };
    return {title,
            Legend::Shape::bar,
            [map](float, float v) { return color_of(map, v); },
            {{1, 1, 1, -1, number(high)}, {1, 0.5f, 1, 0, number(0.5f * (low + high))}, {1, 0, 1, 1, number(low)}}};
}

Legend aolp_legend(AolpStyle style) {
    Legend legend{"AoLP deg", Legend::Shape::square, {}, {}};
    legend.color = [style](float u, float v) -> std::optional<Eigen::Vector3f> {
        const float x = 2 * u - 1, y = 2 * v - 1, degree = std::hypot(x, y);
        if (degree > 1.0f) return {};
        const float angle = std::atan2(y, x);
        return seen([style](const StokesPlane& plane) { return aolp_view(plane, style); },
                    {1.0f, degree * std::cos(2 * angle), degree * std::sin(2 * angle), 0.0f});
    };
    for (const int angle_deg : {0, 45, 90, 135}) {
        const double angle = radians(angle_deg), c = std::cos(angle), s = std::sin(angle);
        const auto side = [](double value) { return std::abs(value) < 0.5 ? 0 : value > 0 ? 1 : -1; };
        legend.marks.push_back({static_cast<float>(0.5 + 0.52 * c), static_cast<float>(0.5 + 0.52 * s), side(c),
                                side(s), std::to_string(angle_deg)});
    }
    return legend;
}

Legend type_legend() {
    Legend legend{"type", Legend::Shape::square, {}, {}};
    legend.color = [](float u, float v) -> std::optional<Eigen::Vector3f> {
        if (std::hypot(u, v) > 1.0f) return {};
        return seen([](const StokesPlane& plane) { return type_view(plane); }, {1.0f, u, 0.0f, v});
    };
    legend.marks = {{0, 1.02f, 1, 1, "circular"}, {1, -0.02f, -1, -1, "linear"}};
    return legend;
}

Legend docp_legend() {
    Legend legend = bar_legend("DoCP", ColorMap::diverging, -1.0f, 1.0f);
    legend.marks.front().text = " 1 right", legend.marks.back().text = "-1 left";
    return legend;
}

Legend chirality_legend() {
    Legend legend = docp_legend();
    legend.color = [](float, float v) {
        return seen([](const StokesPlane& plane) { return chirality_view(plane); }, {1.0f, 0.0f, 0.0f, 2 * v - 1});
    };
    return legend;
}

Bitmap with_legend(const Bitmap& picture, const Legend& legend) {
    PATINA_EXPECT(picture.channel_count() == 3);
    const int scale = std::clamp(picture.height / 256, 1, 4);
    const PixelText title{legend.title, scale};
    const int title_room = legend.title.empty() ? 0 : title.height() + gap;

    // Lay the key out at the origin, and its marks around it.
    const bool bar = legend.shape == Legend::Shape::bar;
    const int side = std::max(smallest_side, picture.height / 4);
    const Box key = bar ? Box{0, 0, bar_width * scale, picture.height - 2 * gap - title_room} : Box{0, 0, side, side};
    Box all = key;
    std::vector<Box> places;
    for (const Legend::Mark& mark : legend.marks) {
        places.push_back(place(mark, {mark.text, scale}, key, bar ? gap : scale));
        all.include(places.back());
    }
    all.top -= title_room, all.right = std::max(all.right, all.left + title.width());
    const int margin = picture.height - (all.bottom - all.top);
    if (margin < gap || key.bottom < lowest_bar) return picture;

    // Draw them beside the picture, in the middle of its height.
    Bitmap wide = widened(picture, all.right - all.left + 2 * gap);
    const int dx = picture.width + gap - all.left, dy = margin / 2 - all.top;
    draw_key(wide, {key.left + dx, key.top + dy, key.right + dx, key.bottom + dy}, legend);
    for (std::size_t i = 0; i < places.size(); ++i)
        draw_text(wide, places[i].left + dx, places[i].top + dy, {legend.marks[i].text, scale},
                  Eigen::Vector3f::Ones());
    draw_text(wide, all.left + dx, all.top + dy, title, Eigen::Vector3f::Ones());
    return wide;
}

}  // namespace patina::io
