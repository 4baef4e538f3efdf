#pragma once
// The standard colorimetric observers of the CIE, and the photopic observer.

#include <Eigen/Dense>

namespace patina::spectral {

enum class Observer {
    cie1931_2deg,  // images, small fields
    cie1964_10deg  // paint chips, large fields
};

// Colour matching functions (xbar, ybar, zbar): the CIE's values every 5 nm on [360, 830] nm, polynomials of
// the fifth degree between them (as CIE 167:2005 recommends for evenly spaced values), zero outside.
Eigen::Vector3d colour_matching(Observer observer, double wavelength_nm);

// Sum of ybar times 5 nm, the integral that makes a uniform unit spectrum Y = 1: 106.857 nm (2 deg), 116.662 nm (10
// deg).
double luminance_integral_nm(Observer observer);

// Photopic luminous efficiency V(lambda) = ybar of the 2 degree observer, and its maximum efficacy K_m
// (CIE 15:2004; definition of the candela).
double photopic_efficiency(double wavelength_nm);
inline constexpr double luminous_efficacy_lm_per_w = 683.0;

}  // namespace patina::spectral
