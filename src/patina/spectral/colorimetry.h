#pragma once
// Spectra to colours: XYZ, linear and encoded sRGB, CIE L*a*b*, chromatic adaptation.
//
// Sums run over 380 to 780 nm every 5 nm, the range and step behind the white points the CIE publishes (CIE 15:2004,
// section 7.1); beyond it lies 4e-6 of Y. Structure narrower than the step is not resolved.

#include <Eigen/Dense>

#include "patina/spectral/observer.h"
#include "patina/spectral/spectrum.h"

namespace patina::spectral {

// XYZ of radiance, normalised so that a uniform unit spectrum has Y = 1; the convention of rendered images.
Eigen::Vector3d xyz_of_radiance(const SpectralFunction& radiance, Observer observer = Observer::cie1931_2deg);

// XYZ of an object under an illuminant, Y = 1 for the perfect reflecting diffuser. `reflectance` is a reflectance
// factor.
Eigen::Vector3d xyz_of_reflectance(const SpectralFunction& reflectance, const SpectralFunction& illuminant,
                                   Observer observer = Observer::cie1931_2deg);

// XYZ of the perfect reflecting diffuser under the illuminant, Y = 1.
Eigen::Vector3d white_point(const SpectralFunction& illuminant, Observer observer = Observer::cie1931_2deg);

// (x, y) = (X, Y)/(X + Y + Z); (0, 0) for black.
Eigen::Vector2d chromaticity(const Eigen::Vector3d& xyz);

// Linear sRGB from the primaries and the white (x, y) = (0.3127, 0.3290) of IEC 61966-2-1; no white balance, no
// clipping.
Eigen::Vector3d xyz_to_linear_srgb(const Eigen::Vector3d& xyz);
Eigen::Vector3d linear_srgb_to_xyz(const Eigen::Vector3d& rgb);

// The transfer function of IEC 61966-2-1 and its inverse, odd about zero, unbounded above.
double srgb_encode(double linear);
double srgb_decode(double encoded);

// CIE 1976 (L*, a*, b*) against a white (CIE 15:2004, section 8.2.1), and its inverse.
Eigen::Vector3d xyz_to_lab(const Eigen::Vector3d& xyz, const Eigen::Vector3d& white);
Eigen::Vector3d lab_to_xyz(const Eigen::Vector3d& lab, const Eigen::Vector3d& white);

// The matrix that carries XYZ seen under the white `from` to the corresponding colour under `to`: von Kries scaling of
// Bradford's cone responses (Lam 1985; the linear form of ICC.1:2010, annex E).
Eigen::Matrix3d bradford_adaptation(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace patina::spectral
