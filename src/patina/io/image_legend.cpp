#include "patina/io/image_legend.h"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "patina/core/contract.h"

namespace patina::io {

namespace {

constexpr int lowest_picture = 32;
constexpr int gap = 8, bar_width = 16, glyph_width = 5, glyph_height = 7;

struct Glyph {
    char character;
    std::array<unsigned char, glyph_height> rows;  // 5 bits a row, the highest at the left
};

constexpr std::array<Glyph, 15> glyphs{{{'0', {14, 17, 19, 21, 25, 17, 14}},
                                        {'1', {4, 12, 4, 4, 4, 4, 14}},
                                        {'2', {14, 17, 1, 2, 4, 8, 31}},
                                        {'3', {31, 2, 4, 2, 1, 17, 14}},
                                        {'4', {2, 6, 10, 18, 31, 2, 2}},
                                        {'5', {31, 16, 30, 1, 1, 17, 14}},
                                        {'6', {6, 8, 16, 30, 17, 17, 14}},
                                        {'7', {31, 1, 2, 4, 8, 8, 8}},
                                        {'8', {14, 17, 17, 14, 17, 17, 14}},
                                        {'9', {14, 17, 17, 15, 1, 2, 12}},
                                        {'-', {0, 0, 0, 31, 0, 0, 0}},
                                        {'.', {0, 0, 0, 0, 0, 12, 12}},
                                        {'e', {0, 0, 14, 17, 31, 16, 14}},
                                        {'+', {0, 4, 4, 31, 4, 4, 0}},
                                        {' ', {0, 0, 0, 0, 0, 0, 0}}}};

void set_pixel(Bitmap& picture, int x, int y, const Eigen::Vector3f& color) {
    if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
    std::copy_n(color.data(), 3, picture.data.begin() + (static_cast<std::ptrdiff_t>(y) * picture.width + x) * 3);
}

void draw_text(Bitmap& picture, int x, int y, const std::string& text, int scale) {
    for (const char character : text) {
        const auto glyph =
            std::find_if(glyphs.begin(), glyphs.end(), [&](const Glyph& g) { return g.character == character; });
        if (glyph != glyphs.end())
            for (int row = 0; row < glyph_height * scale; ++row)
                for (int column = 0; column < glyph_width * scale; ++column)
                    if (glyph->rows[row / scale] >> (glyph_width - 1 - column / scale) & 1)
                        set_pixel(picture, x + column, y + row, Eigen::Vector3f::Ones());
        x += (glyph_width + 1) * scale;
    }
}

}  // namespace

Bitmap with_legend(const Bitmap& picture, const Legend& legend) {
    PATINA_EXPECT(picture.channel_count() == 3);
    if (picture.height < lowest_picture) return picture;
    const std::array<std::string, 3> numbers{fmt::format("{:.3g}", legend.high),
                                             fmt::format("{:.3g}", 0.5f * (legend.low + legend.high)),
                                             fmt::format("{:.3g}", legend.low)};
    std::size_t longest = 0;
    for (const std::string& number : numbers) longest = std::max(longest, number.size());
    const int scale = std::clamp(picture.height / 256, 1, 4);
    const int text_width = static_cast<int>(longest) * (glyph_width + 1) * scale;

    // Copy the picture onto a wider black one.
    Bitmap wide{picture.name,
                picture.width + 2 * gap + bar_width * scale + text_width + gap,
                picture.height,
                picture.channels,
                {}};
    wide.data.assign(static_cast<std::size_t>(wide.width) * wide.height * 3, 0.0f);
    for (int y = 0; y < picture.height; ++y)
        std::copy_n(picture.data.begin() + static_cast<std::ptrdiff_t>(y) * picture.width * 3, picture.width * 3,
                    wide.data.begin() + static_cast<std::ptrdiff_t>(y) * wide.width * 3);

    // Draw the bar and its numbers.
    const int top = gap, bottom = picture.height - gap, left = picture.width + gap;
    for (int y = top; y < bottom; ++y) {
        const float share = static_cast<float>(bottom - 1 - y) / static_cast<float>(bottom - 1 - top);
        for (int x = 0; x < bar_width * scale; ++x) set_pixel(wide, left + x, y, color_of(legend.map, share));
    }
    const int text_left = left + bar_width * scale + gap;
    const int half = glyph_height * scale;
    draw_text(wide, text_left, top, numbers[0], scale);
    draw_text(wide, text_left, (top + bottom - half) / 2, numbers[1], scale);
    draw_text(wide, text_left, bottom - half, numbers[2], scale);
    return wide;
}

}  // namespace patina::io
