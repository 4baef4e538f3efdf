#pragma once
// Numbers as colours. All colours are linear sRGB, as Bitmap has them.

#include <Eigen/Dense>

namespace patina::io {

enum class ColorMap {
    grey,      // encoded evenly: 0.5 is the middle grey code
    viridis,   // dark blue to yellow, perceptually even (van der Walt & Smith 2015)
    inferno,   // black to pale yellow, perceptually even (van der Walt & Smith 2015)
    diverging  // blue, light grey at the middle, red (Moreland 2009)
};

// The colour at `position` in [0, 1]; clamped outside, magenta for NaN.
Eigen::Vector3f color_of(ColorMap map, float position);

// Hue in turns, saturation and value in [0, 1] (Smith 1978), taken as encoded sRGB and made linear.
Eigen::Vector3f color_of_hsv(float hue, float saturation, float value);

// Encoded sRGB made linear.
Eigen::Vector3f linear_color(const Eigen::Vector3f& encoded);

// What stands for a pixel that is not a number: no map has it.
inline Eigen::Vector3f not_a_number_color() {
    return {1.0f, 0.0f, 1.0f};
}

}  // namespace patina::io
