#include "patina/spectral/scene_spectrum.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "patina/core/contract.h"
#include "patina/spectral/illuminants.h"
#include "patina/spectral/rgb_upsampling.h"

namespace patina::spectral {

namespace {

using Kind = SpectrumSpec::Kind;

// Throws for a value outside [0, largest].
void expect_values(const SpectrumSpec& spec, double largest, const char* what, const SourceLocation& where) {
    for (double value : spec.values)
        if (!(value >= 0.0 && value <= largest))
            throw input_error(where, fmt::format("{} is no {}", value, what),
                              largest > 1.0 ? "it must be a finite number, 0 or larger"
                                            : fmt::format("it must lie between 0 and {}", largest));
    if (spec.values.empty()) throw input_error(where, "the spectrum has no values");
}

// What means the same for every use: one value, or samples.
Spectrum plain_spectrum(const SpectrumSpec& spec, Outside outside, const SourceLocation& where) {
    if (spec.kind == Kind::uniform) return Spectrum(spec.values[0]);
    if (spec.wavelengths_nm.size() != spec.values.size())
        throw input_error(where,
                          fmt::format("{} wavelengths but {} values", spec.wavelengths_nm.size(), spec.values.size()));
    for (size_t i = 0; i < spec.wavelengths_nm.size(); ++i) {
        const double wavelength_nm = spec.wavelengths_nm[i];
        if (!(wavelength_nm > 0.0) || std::isinf(wavelength_nm) ||
            (i > 0 && wavelength_nm <= spec.wavelengths_nm[i - 1]))
            throw input_error(where, fmt::format("wavelength {} nm is out of order", wavelength_nm),
                              "wavelengths must be positive and ascend");
    }
    return Spectrum(spec.wavelengths_nm, spec.values, outside);
}

Eigen::Vector3d rgb_of(const SpectrumSpec& spec) {
    PATINA_EXPECT(spec.values.size() == 3);
    return {spec.values[0], spec.values[1], spec.values[2]};
}

// A smooth spectrum for a colour of any brightness. Components up to 1/2 leave the smooth curve room to overshoot.
SpectralFunction scaled_colour(const Eigen::Vector3d& rgb) {
    const double brightest = rgb.maxCoeff();
    if (rgb.minCoeff() == brightest) return Spectrum(brightest);
    const double scale = brightest > 1 ? 2 * brightest : 1.0;
    return [scale, smooth = upsampled_reflectance(rgb / scale)](double nm) { return scale * smooth(nm); };
}

constexpr double largest_finite = std::numeric_limits<double>::max();

}  // namespace

SpectralFunction reflectance_spectrum(const SpectrumSpec& spec, const SourceLocation& where) {
    if (spec.kind == Kind::blackbody)
        throw input_error(where, "a black body is no reflectance", "it describes a light");
    expect_values(spec, 1.0, "reflectance", where);
    if (spec.kind == Kind::rgb) return upsampled_reflectance(rgb_of(spec));
    return plain_spectrum(spec, Outside::hold, where);
}

SpectralFunction emission_spectrum(const SpectrumSpec& spec, const SourceLocation& where) {
    expect_values(spec, largest_finite, "radiance", where);
    if (spec.kind == Kind::rgb) return upsampled_emission(rgb_of(spec));
    if (spec.kind != Kind::blackbody) return plain_spectrum(spec, Outside::zero, where);
    const double temperature_k = spec.values[0], scale = spec.values.size() > 1 ? spec.values[1] : 1.0;
    return [=](double wavelength_nm) { return scale * blackbody_radiance(wavelength_nm, temperature_k); };
}

SpectralFunction property_spectrum(const SpectrumSpec& spec, const SourceLocation& where) {
    if (spec.kind == Kind::blackbody)
        throw input_error(where, "a black body is no property of matter", {},
                          "give one number, wavelengths with values, or a built-in material");
    expect_values(spec, largest_finite, "property of matter", where);
    if (spec.kind == Kind::rgb) return scaled_colour(rgb_of(spec));
    return plain_spectrum(spec, Outside::hold, where);
}

}  // namespace patina::spectral
