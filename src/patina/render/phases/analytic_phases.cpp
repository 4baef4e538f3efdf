// The scene-file side of the phase functions that are formulas.
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/phases/henyey_greenstein.h"
#include "patina/render/phases/isotropic.h"
#include "patina/render/phases/rayleigh.h"

namespace patina::render {

PluginDescriptor IsotropicPhase::describe() {
    return {"phase", "isotropic", "Into every direction alike; depolarizes.", {}};
}
IsotropicPhase IsotropicPhase::build(const Properties&, const PhaseBuilder&) {
    return {};
}

PluginDescriptor HenyeyGreensteinPhase::describe() {
    return {"phase",
            "hg",
            "Henyey and Greenstein's law; depolarizes.",
            {{"g", "number", "", "0.8", "-0.999 .. 0.999", "mean cosine of the scattering angle"}}};
}
HenyeyGreensteinPhase HenyeyGreensteinPhase::build(const Properties& node, const PhaseBuilder&) {
    const double g = node.number("g", 0.8);
    if (!(std::abs(g) <= 0.999))
        throw input_error(node.location_of("g"), "mean cosine out of range", fmt::format("it is {}", g),
                          "keep it within -0.999 .. 0.999");
    return {static_cast<float>(g)};
}

PluginDescriptor RayleighPhase::describe() {
    return {"phase",
            "rayleigh",
            "Particles much smaller than the wavelength, polarized.",
            {{"depolarization", "number", "", "0", "0 .. 0.5", "factor rho for natural light; 0.028 air"}}};
}
RayleighPhase RayleighPhase::build(const Properties& node, const PhaseBuilder&) {
    const double rho = node.number("depolarization", 0);
    if (!(rho >= 0 && rho <= 0.5))
        throw input_error(node.location_of("depolarization"), "depolarization factor out of range",
                          fmt::format("it is {}", rho), "keep it within 0 .. 0.5");
    return {static_cast<float>((1 - rho) / (1 + rho / 2)), static_cast<float>((1 - 2 * rho) / (1 - rho))};
}

}  // namespace patina::render
