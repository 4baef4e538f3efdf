#pragma once
// Light sources of the CIE and of physics. Relative illuminants carry the CIE's own scale (100 at 560 nm for A and
// daylight).

#include <string>
#include <string_view>
#include <vector>

#include "patina/core/error.h"
#include "patina/spectral/spectrum.h"

namespace patina::spectral {

// Equal energy, 100 everywhere.
Spectrum illuminant_e();

// Incandescent light on [300, 830] nm every 5 nm: Planck's formula at the CIE's 2848 K with c2 = 1.435e-2 m K
// (CIE 15:2004, equation 3.1).
Spectrum illuminant_a();

// Daylight of a correlated colour temperature in [4000, 25000] K, [300, 830] nm (CIE 15:2004, equations 3.3 to 3.6).
// Throws Error(input) for another temperature.
Spectrum daylight(double correlated_colour_temperature_k);

// Daylight at the temperatures the CIE gives after the change of c2, 6504 K and 5003 K, with its rounding of the
// coefficients M1 and M2 to three decimals, which its published tables contain.
Spectrum illuminant_d65();
Spectrum illuminant_d50();

// Fluorescent lamps, [380, 780] nm: F2 "cool white", F11 three narrow bands ("TL84").
Spectrum illuminant_f2();
Spectrum illuminant_f11();

// By the names "A", "D50", "D65", "E", "F2", "F11"; Throws Error(input) at `where` for another.
Spectrum illuminant(std::string_view name, const SourceLocation& where = {});
std::vector<std::string> illuminant_names();

// Spectral radiance of a black body, W m^-2 sr^-1 nm^-1 (Planck, exact SI constants of 2019).
double blackbody_radiance(double wavelength_nm, double temperature_k);

}  // namespace patina::spectral
