#pragma once
// Quantities of radiometry, their spectral densities and their photometric twins (CIE 17.2:2020, International Lighting
// Vocabulary).
//
// | quantity           | per unit of        | spectral density  | over 380 .. 780 nm | weighed by V      |
// |--------------------|--------------------|-------------------|--------------------|-------------------|
// | energy             |                    | J/nm              | J                  | lm s (talbot)     |
// | flux               | time               | W/nm              | W                  | lm                |
// | intensity          | solid angle        | W/(sr nm)         | W/sr               | cd = lm/sr        |
// | irradiance         | area that receives | W/(m^2 nm)        | W/m^2              | lx = lm/m^2       |
// | radiosity          | area that sends    | W/(m^2 nm)        | W/m^2              | lm/m^2            |
// | radiance           | both, cos          | W/(m^2 sr nm)     | W/(m^2 sr)         | nit = cd/m^2      |
//
// X_v = K_m int V(lambda) X_lambda d lambda with V the CIE 1924 luminous efficiency, the y of the 1931 observer, and
// K_m = 683 lm/W. Units hold when the scene's unit of length is the metre and its emitters are in the units above.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "patina/core/stokes_image.h"

namespace patina::render {

enum class Quantity { flux, intensity, irradiance, radiosity, radiance };

struct QuantityNames {
    const char *name, *unit, *spectral_unit, *photometric_name, *photometric_unit;
};
const QuantityNames& names_of(Quantity quantity);

// What a meter read: means over its film (a goniophotometer's film is all directions).
struct Measurement {
    Quantity quantity = Quantity::radiance;
    std::vector<double> spectral;         // [bin][stokes], in the spectral unit; bins as in the picture
    std::array<double, 4> radiometric{};  // of each Stokes component, over the bins
    std::array<double, 4> photometric{};  // weighed by V
    double standard_error = 0;            // of the photometric value of S0; 0 when not known
    double exposure_s = 0;                // shutter time; times it flux is energy, irradiance radiant exposure
    // Goniophotometer: flux through the whole sphere, W and lm, and the largest photometric value of a pixel.
    std::optional<std::array<double, 2>> total_flux;
    double peak = 0;
};

// The mean of a picture that holds `quantity`. `all_directions`: its film covers the sphere in pixels of equal solid
// angle.
Measurement measure(const StokesImage& image, Quantity quantity, bool all_directions);

}  // namespace patina::render
