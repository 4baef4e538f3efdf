#pragma once
// The pictures polarization people know, under polanalyser's names. Each makes linear RGB for write_png.
//
// Pixels that are not numbers are magenta, never black in silence.

#include <vector>

#include "patina/core/bitmap.h"
#include "patina/io/image_colormap.h"
#include "patina/io/image_stokes.h"

namespace patina::io {

// Degree of linear polarization from 0 to 1.
Bitmap dolp_view(const StokesPlane& plane, ColorMap map = ColorMap::grey);

// Angle of linear polarization as hue over 180 degrees: 0 red, 60 green, 120 blue.
enum class AolpStyle {
    full,   // saturation and value 1
    light,  // saturation is the DoLP: unpolarized light is white
    dark    // value is the DoLP: unpolarized light is black
};
Bitmap aolp_view(const StokesPlane& plane, AolpStyle style = AolpStyle::dark);

// Degree of circular polarization S3/S0 from -1 (left, blue) to 1 (right, red).
Bitmap docp_view(const StokesPlane& plane);

// Type of polarization (Wilkie & Weidlich 2010): cyan where linear, yellow where circular, as bright as the degree of
// polarization.
Bitmap type_view(const StokesPlane& plane);

// Chirality of polarization (Wilkie & Weidlich 2010): blue where right circular, yellow where left, as bright as the
// degree of circular polarization.
Bitmap chirality_view(const StokesPlane& plane);

// A component on the diverging map from -range to range (S0 on inferno from 0 to range). `normalized` divides by S0.
// A range of 0 takes the 99.5th percentile of the absolute values; `used_range` tells which it was, for the legend.
Bitmap stokes_view(const StokesPlane& plane, int component, bool normalized, float range, float& used_range);

// Numbers of 0 and above, one a pixel of the picture, on inferno from 0 to range (0: found as above).
Bitmap share_view(const StokesImage& image, const std::vector<float>& values, float range, float& used_range);

}  // namespace patina::io
