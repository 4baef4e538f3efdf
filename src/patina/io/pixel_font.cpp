#include "patina/io/pixel_font.h"

#include <algorithm>
#include <array>

namespace patina::io {

namespace {

constexpr int glyph_width = 5, glyph_height = 7, advance = glyph_width + 1;

struct Glyph {
    char character;
    std::array<unsigned char, glyph_height> rows;  // 5 bits a row, the highest at the left
};

constexpr std::array<Glyph, 40> glyphs{
    {{'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},      {'2', {14, 17, 1, 2, 4, 8, 31}},
     {'3', {31, 2, 4, 2, 1, 17, 14}},     {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
     {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},       {'8', {14, 17, 17, 14, 17, 17, 14}},
     {'9', {14, 17, 17, 15, 1, 2, 12}},   {'-', {0, 0, 0, 31, 0, 0, 0}},       {'+', {0, 4, 4, 31, 4, 4, 0}},
     {'.', {0, 0, 0, 0, 0, 12, 12}},      {'/', {0, 1, 2, 4, 8, 16, 0}},       {' ', {0, 0, 0, 0, 0, 0, 0}},
     {'A', {14, 17, 17, 31, 17, 17, 17}}, {'C', {14, 17, 16, 16, 16, 17, 14}}, {'D', {28, 18, 17, 17, 17, 18, 28}},
     {'L', {16, 16, 16, 16, 16, 16, 31}}, {'P', {30, 17, 17, 30, 16, 16, 16}}, {'S', {15, 16, 16, 14, 1, 1, 30}},
     {'a', {0, 0, 14, 1, 15, 17, 15}},    {'c', {0, 0, 14, 16, 16, 17, 14}},   {'d', {1, 1, 13, 19, 17, 17, 15}},
     {'e', {0, 0, 14, 17, 31, 16, 14}},   {'f', {6, 9, 8, 28, 8, 8, 8}},       {'g', {0, 15, 17, 17, 15, 1, 14}},
     {'h', {16, 16, 22, 25, 17, 17, 17}}, {'i', {4, 0, 12, 4, 4, 4, 14}},      {'l', {12, 4, 4, 4, 4, 4, 14}},
     {'n', {0, 0, 22, 25, 17, 17, 17}},   {'o', {0, 0, 14, 17, 17, 17, 14}},   {'p', {0, 0, 30, 17, 30, 16, 16}},
     {'r', {0, 0, 22, 25, 16, 16, 16}},   {'s', {0, 0, 14, 16, 14, 1, 30}},    {'t', {8, 8, 28, 8, 8, 9, 6}},
     {'u', {0, 0, 17, 17, 17, 19, 13}},   {'y', {0, 0, 17, 17, 15, 1, 14}},    {'m', {0, 0, 26, 21, 21, 17, 17}},
     {'v', {0, 0, 17, 17, 17, 10, 4}}}};

const Glyph* glyph_of(char character) {
    const auto* found =
        std::find_if(glyphs.begin(), glyphs.end(), [&](const Glyph& glyph) { return glyph.character == character; });
    return found == glyphs.end() ? nullptr : found;
}

}  // namespace

int PixelText::width() const {
    return static_cast<int>(text.size()) * advance * scale;
}

int PixelText::height() const {
    return glyph_height * scale;
}

bool has_glyphs_for(const std::string& text) {
    return std::all_of(text.begin(), text.end(), [](char character) { return glyph_of(character) != nullptr; });
}

void set_pixel(Bitmap& picture, int x, int y, const Eigen::Vector3f& color) {
    if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
    std::copy_n(color.data(), 3, picture.data.begin() + (static_cast<std::ptrdiff_t>(y) * picture.width + x) * 3);
}

void draw_text(Bitmap& picture, int x, int y, const PixelText& text, const Eigen::Vector3f& color) {
    for (const char character : text.text) {
        if (const Glyph* glyph = glyph_of(character))
            for (int row = 0; row < glyph_height * text.scale; ++row)
                for (int column = 0; column < glyph_width * text.scale; ++column)
                    if (glyph->rows[row / text.scale] >> (glyph_width - 1 - column / text.scale) & 1)
                        set_pixel(picture, x + column, y + row, color);
        x += advance * text.scale;
    }
}

}  // namespace patina::io
