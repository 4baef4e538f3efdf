#pragma once
// What is in a picture, and how two pictures differ.

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "patina/core/stokes_image.h"

namespace patina::io {

// Of one Stokes component over all pixels and all bands compared, or over all pixels of one colour channel; a - b.
struct ComponentDifference {
    double root_mean_square = 0;
    double mean = 0;  // signed
    double mean_absolute = 0;
    double largest = 0;  // absolute
    int largest_x = 0, largest_y = 0;
};

struct ImageDifference {
    std::string bands;  // "spectral" when both have the same bins, else "rgb"
    std::array<ComponentDifference, 4> stokes;
    std::array<std::array<ComponentDifference, 3>, 4> rgb;  // [stokes][channel] of linear sRGB
    std::size_t not_finite = 0;                             // values of `bands` left out
};

// Throws Error(input) when the sizes differ.
ImageDifference compare_images(const StokesImage& a, const StokesImage& b);

// a - b, with the bins only when both have the same. Throws Error(input) when the sizes differ.
StokesImage subtract_images(const StokesImage& a, const StokesImage& b);

// Of one Stokes component in each pixel, by the luminance: |a - b| over S0 of the reference b, and the standard error
// that the picture states of itself over S0. 0 where S0 is below a ten-thousandth of the picture's mean.
// relative_errors throws Error(input) when the sizes differ, relative_noise when the picture has no variance.
std::vector<float> relative_errors(const StokesImage& a, const StokesImage& b, int component);
std::vector<float> relative_noise(const StokesImage& image, int component);

struct ImageSummary {
    std::array<double, 4> mean{}, smallest{}, largest{};  // luminance of S0..S3
    double mean_dolp = 0;                                 // weighted with S0: |(S1, S2)| over S0, each summed
    double largest_dolp = 0;                              // over pixels of more than a thousandth of the mean luminance
    std::size_t not_finite = 0;                           // pixels
    std::size_t over_polarized = 0;  // pixels with a degree of polarization above 1 + 1e-3: noise or a mistake
};

ImageSummary summarize_image(const StokesImage& image);

}  // namespace patina::io
