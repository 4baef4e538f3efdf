#pragma once
// Letters of 5 x 7 pixels, for the few words that pictures carry.

#include <string>

#include <Eigen/Dense>

#include "patina/core/bitmap.h"

namespace patina::io {

struct PixelText {
    std::string text;
    int scale = 1;  // pixels a dot of the letters

    int width() const;
    int height() const;
};

bool has_glyphs_for(const std::string& text);

// Draws the text into an R, G, B picture with its upper left corner at (x, y); what lies outside is left out, and a
// character that has no glyph leaves its room empty.
void draw_text(Bitmap& picture, int x, int y, const PixelText& text, const Eigen::Vector3f& color);

void set_pixel(Bitmap& picture, int x, int y, const Eigen::Vector3f& color);

}  // namespace patina::io
