#pragma once
// Absorption and scattering of a translucent matter, from numbers or from a recipe's layer.

#include <map>
#include <optional>

#include "patina/core/properties.h"
#include "patina/render/scene_resources.h"
#include "patina/render/spectrum.h"

namespace patina::render {

// A recipe's layer as a scene names it: `filename`, `layer`, `scene_unit_um`.
struct LayerInScene {
    std::shared_ptr<const optics::SpectralMedium> medium;
    double unit_um = 1;

    // A property of the layer per wavelength, linear between the wavelengths of its grid.
    Spectrum spectrum(const std::function<double(const optics::ScatteringMedium&)>& value) const;
    Spectrum host_index() const;
};
// Notes what the recipe assumed and cites. Throws Error(input) for values out of range, Error(not_built) without a
// reader.
LayerInScene layer_in_scene(const Properties& node, const SceneResources& resources,
                            std::map<std::string, std::string>& notes);

// The spectrum `name` of a medium, or that of the child <volume type="constvolume" name="...">; none when neither is
// given.
struct GivenSpectrum {
    SpectrumSpec spec;
    SourceLocation where;
};
std::optional<GivenSpectrum> given_spectrum(const Properties& node, const char* name);

// A coefficient per length, `name`, in 0 .. infinity, or the fallback.
Spectrum coefficient(const Properties& node, const char* name, float fallback);
double factor(const Properties& node, const char* name);  // >= 0, 1 by default
Spectrum scaled(const Spectrum& table, double factor);

// Per scene unit: sigma_a and sigma_s (1 - g), of the properties sigma_a, sigma_s, g and scale, or of a recipe.
struct ReducedCoefficients {
    Spectrum absorption, scattering;
    std::optional<Spectrum> index;  // a recipe's binder
};
ReducedCoefficients reduced_coefficients(const Properties& node, const SceneResources& resources,
                                         std::map<std::string, std::string>& notes);

}  // namespace patina::render
