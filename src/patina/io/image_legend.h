#pragma once
// What the colours of a view mean, drawn beside it.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "patina/core/bitmap.h"
#include "patina/io/image_colormap.h"
#include "patina/io/image_views.h"

namespace patina::io {

struct Legend {
    enum class Shape {
        bar,    // as high as the picture
        square  // a quarter of its height
    };
    // A word at (u, v) of the key, or beside that point: right = -1 ends there, 0 has its middle there, 1 begins there;
    // likewise `up`.
    struct Mark {
        float u = 0.0f, v = 0.0f;
        int right = 1, up = 0;
        std::string text;
    };

    std::string title;
    Shape shape = Shape::bar;
    // The colour at (u, v) in [0, 1]^2, u to the right and v up; none outside of the key.
    std::function<std::optional<Eigen::Vector3f>(float u, float v)> color;
    std::vector<Mark> marks;
};

// The map from bottom to top, with three numbers.
Legend bar_legend(const std::string& title, ColorMap map, float low, float high);

// Keys of the views of the same names. Their colours are those that the views give to the Stokes vectors they stand
// for.
Legend aolp_legend(AolpStyle style);  // a disc: light that vibrates along a radius, the more polarized the further out
Legend type_legend();                 // a quarter of a disc: linear to the right, circular upward
Legend docp_legend();
Legend chirality_legend();

// The picture (R, G, B) with the legend at its right. The height stays the same; a picture too low for the legend is
// returned as it is.
Bitmap with_legend(const Bitmap& picture, const Legend& legend);

}  // namespace patina::io
