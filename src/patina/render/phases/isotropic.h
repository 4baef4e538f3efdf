#pragma once
// `isotropic`: into every direction alike, a1 = 1. Depolarizes: a stand-in where no particle is known.

#include "patina/render/phase.h"

namespace patina::render {

struct IsotropicPhase {
    PhaseElements elements(const Wavelengths&, float) const {
        PhaseElements f;
        f.a1 = splat(1);
        return f;
    }
    float sample_cosine(const Wavelengths&, int, float u) const { return 1 - 2 * u; }

    static PluginDescriptor describe();
    static IsotropicPhase build(const Properties& node, const PhaseBuilder& builder);
};

}  // namespace patina::render
