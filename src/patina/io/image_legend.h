#pragma once
// A colour bar with its numbers beside a picture.

#include "patina/core/bitmap.h"
#include "patina/io/image_colormap.h"

namespace patina::io {

struct Legend {
    ColorMap map = ColorMap::grey;
    float low = 0.0f, high = 1.0f;  // at the bottom and the top of the bar
};

// The picture (R, G, B) with the bar at its right and three numbers: high, middle and low. The height stays the same;
// pictures lower than 32 pixels are returned as they are.
Bitmap with_legend(const Bitmap& picture, const Legend& legend);

}  // namespace patina::io
