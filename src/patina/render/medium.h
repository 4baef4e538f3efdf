#pragma once
// What fills the space between surfaces: homogeneous scattering and absorbing media, and the closed sets of phase
// functions and media that scene files name.
//
// Lengths are scene units. A shape with a medium inside or outside (`interior`, `exterior`) is its boundary: who
// crosses it enters the one it names for that side, the vacuum where it names none. Shapes without either leave the
// medium as it is, on both sides.

#include <memory>
#include <variant>
#include <vector>

#include "patina/optics/scattering/spectral_medium.h"
#include "patina/render/phases/henyey_greenstein.h"
#include "patina/render/phases/isotropic.h"
#include "patina/render/phases/mie.h"
#include "patina/render/phases/rayleigh.h"

namespace patina::render {

template <PhaseModel... Models>
using PhaseVariant = std::variant<Models...>;
using Phase = PhaseVariant<IsotropicPhase, HenyeyGreensteinPhase, RayleighPhase, MiePhase>;

inline PhaseElements phase_elements(const Phase& phase, const Wavelengths& w, float cosine) {
    return std::visit([&](const auto& model) { return model.elements(w, cosine); }, phase);
}
inline float phase_sample_cosine(const Phase& phase, const Wavelengths& w, int lane, float u) {
    return std::visit([&](const auto& model) { return model.sample_cosine(w, lane, u); }, phase);
}

inline constexpr int vacuum = -1;  // in place of a medium's index

struct Medium {
    Spectrum extinction;  // per scene unit
    Spectrum albedo;      // of single scattering
    Phase phase;

    // Unscattered share of light over a distance, which may be infinite.
    static Float4 transmittance(Float4 extinction, float distance) {
        Float4 t;
        for (int i = 0; i < wavelengths_per_path; ++i)
            t[i] = extinction[i] > 0 ? std::exp(-extinction[i] * distance) : 1.0f;
        return t;
    }
};

std::vector<PluginDescriptor> medium_descriptors();  // of the media, and of the phase functions

// The medium a plugin names. Throws Error(input) for unknown plugins, properties and values out of range.
Medium build_medium(const Properties& node, const PhaseBuilder& builder);

}  // namespace patina::render
