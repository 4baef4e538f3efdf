#pragma once
// One Stokes vector a pixel, taken out of a picture with many bands, and the numbers people read off it.

#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "patina/core/stokes_image.h"

namespace patina::io {

// The convention is that of core/stokes_image.h.
struct StokesPlane {
    int width = 0, height = 0;
    std::vector<Eigen::Vector4f> pixels;  // row 0 on top
};

// Which band of the picture. By default the luminance Y of each component.
struct BandChoice {
    std::optional<double> wavelength_nm;  // the bin that holds it
    std::optional<int> colour;            // 0, 1, 2: the red, green or blue plane
};

// Throws Error(usage) for a wavelength outside of the picture's bins, naming their range, and for a colour not 0..2.
StokesPlane select_band(const StokesImage& image, const BandChoice& choice = {});

// Degree of polarization, of linear polarization, of circular polarization (signed, right positive); 0 for a dark
// pixel. They are not clamped: noise can make them larger than 1.
float dop(const Eigen::Vector4f& stokes);
float dolp(const Eigen::Vector4f& stokes);
float docp(const Eigen::Vector4f& stokes);

// Angle of linear polarization in [0, 180) degrees, counter-clockwise from the picture's horizontal as the camera sees
// it.
float aolp_deg(const Eigen::Vector4f& stokes);

}  // namespace patina::io
