#pragma once
// Smooth spectra for linear sRGB colours: the sigmoid of a quadratic in wavelength (Jakob & Hanika 2019, "A
// low-dimensional function space for efficient spectral upsampling"), with the coefficients found for each colour
// instead of read from a table.

#include <Eigen/Dense>

#include "patina/spectral/spectrum.h"

namespace patina::spectral {

// S(c0 t^2 + c1 t + c2), S(x) = 1/2 + x/(2 sqrt(1 + x^2)), t = (wavelength - 595 nm)/235 nm; always in [0, 1]. Infinite
// c2 is black or white.
class SigmoidReflectance {
  public:
    explicit SigmoidReflectance(const Eigen::Vector3d& coefficients) : coefficients_(coefficients) {}
    double operator()(double wavelength_nm) const;
    const Eigen::Vector3d& coefficients() const { return coefficients_; }

  private:
    Eigen::Vector3d coefficients_;
};

// A reflectance whose colour under D65 is `rgb`, clamped to [0, 1]; within 1e-3 in each channel. Greys are constant.
SigmoidReflectance upsampled_reflectance(const Eigen::Vector3d& rgb);

// Radiance of the colour `rgb` (negative channels are taken as 0): D65 with Y = 1, times a smooth spectrum. (1, 1, 1)
// is D65 itself, whose linear sRGB is (1, 1, 1).
SpectralFunction upsampled_emission(const Eigen::Vector3d& rgb);

}  // namespace patina::spectral
