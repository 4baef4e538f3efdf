#pragma once
// Colours of reflectance spectra as a paint laboratory states them.

#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Dense>

#include "patina/spectral/observer.h"

namespace patina::coating {

struct Viewing {
    std::string_view illuminant;  // a name of spectral::illuminant_names()
    spectral::Observer observer;
};

inline constexpr Viewing laboratory_viewing{"D65", spectral::Observer::cie1964_10deg};

// D65, A and F11, each with the 2 and the 10 degree observer.
std::span<const Viewing> usual_viewings();

// "2" or "10".
int observer_deg(spectral::Observer observer);

// XYZ, Y = 1 for the perfect reflecting diffuser, of reflectance factors at ascending wavelengths: straight lines
// between them, the ends held outside (ASTM E308). One value counts for all wavelengths.
Eigen::Vector3d tristimulus(const std::vector<double>& wavelengths_nm, const std::vector<double>& reflectance,
                            const Viewing& viewing);

// CIE 1976 (L*, a*, b*) of the same.
Eigen::Vector3d lab(const std::vector<double>& wavelengths_nm, const std::vector<double>& reflectance,
                    const Viewing& viewing);

struct WhitenessAndYellowness {
    double whiteness, tint, yellowness;
    bool whiteness_valid;  // inside the region where the formula holds
};

// ASTM E313 for D65 and the 10 degree observer; yellowness is 0 for a perfect black.
WhitenessAndYellowness whiteness(const std::vector<double>& wavelengths_nm, const std::vector<double>& reflectance);

}  // namespace patina::coating
