#include "patina/coating/paint_metrics_colour.h"

#include "patina/core/contract.h"
#include "patina/spectral/colorimetry.h"
#include "patina/spectral/illuminants.h"
#include "patina/spectral/whiteness.h"

namespace patina::coating {

namespace {

using spectral::Observer;

spectral::Spectrum spectrum_of(const std::vector<double>& wavelengths_nm, const std::vector<double>& reflectance) {
    PATINA_EXPECT(!reflectance.empty() && wavelengths_nm.size() == reflectance.size());
    if (reflectance.size() == 1) return spectral::Spectrum(reflectance[0]);
    return {wavelengths_nm, reflectance, spectral::Outside::hold};
}

}  // namespace

std::span<const Viewing> usual_viewings() {
    static constexpr Viewing viewings[] = {{"D65", Observer::cie1931_2deg}, {"D65", Observer::cie1964_10deg},
                                           {"A", Observer::cie1931_2deg},   {"A", Observer::cie1964_10deg},
                                           {"F11", Observer::cie1931_2deg}, {"F11", Observer::cie1964_10deg}};
    return viewings;
}

int observer_deg(Observer observer) {
    return observer == Observer::cie1931_2deg ? 2 : 10;
}

Eigen::Vector3d tristimulus(const std::vector<double>& wavelengths_nm, const std::vector<double>& reflectance,
                            const Viewing& viewing) {
    return spectral::xyz_of_reflectance(spectrum_of(wavelengths_nm, reflectance),
                                        spectral::illuminant(viewing.illuminant), viewing.observer);
}

Eigen::Vector3d lab(const std::vector<double>& wavelengths_nm, const std::vector<double>& reflectance,
                    const Viewing& viewing) {
    return spectral::xyz_to_lab(tristimulus(wavelengths_nm, reflectance, viewing),
                                spectral::white_point(spectral::illuminant(viewing.illuminant), viewing.observer));
}

WhitenessAndYellowness whiteness(const std::vector<double>& wavelengths_nm, const std::vector<double>& reflectance) {
    const Eigen::Vector3d xyz = tristimulus(wavelengths_nm, reflectance, laboratory_viewing);
    const spectral::Whiteness w =
        spectral::astm_e313_whiteness(xyz, spectral::WhitenessLight::d65, laboratory_viewing.observer);
    const double yellowness =
        xyz[1] > 0.0 ? spectral::astm_e313_yellowness(xyz, spectral::WhitenessLight::d65, laboratory_viewing.observer)
                     : 0.0;
    return {w.index, w.tint, yellowness, w.valid};
}

}  // namespace patina::coating
