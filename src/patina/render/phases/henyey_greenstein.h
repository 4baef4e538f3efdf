#pragma once
// `hg`: Henyey & Greenstein (1941), Astrophys. J. 93, 70: a1 = (1 - g^2) / (1 + g^2 - 2 g cos)^(3/2), mean cosine g.
//
// An intensity law, no matrix: it depolarizes. For polarization take `mie` or `rayleigh`.

#include "patina/render/phase.h"

namespace patina::render {

struct HenyeyGreensteinPhase {
    float g = 0;

    PhaseElements elements(const Wavelengths&, float cosine) const {
        const float d = 1 + g * g - 2 * g * cosine;
        PhaseElements f;
        f.a1 = splat((1 - g * g) / (d * std::sqrt(d)));
        return f;
    }
    float sample_cosine(const Wavelengths&, int, float u) const {
        if (std::abs(g) < 1e-3f) return 1 - 2 * u + 1.5f * g * (1 - sqr(1 - 2 * u));
        const float ratio = (1 - g * g) / (1 + g - 2 * g * u);
        return std::clamp((1 + g * g - ratio * ratio) / (2 * g), -1.0f, 1.0f);
    }

    static PluginDescriptor describe();
    static HenyeyGreensteinPhase build(const Properties& node, const PhaseBuilder& builder);
};

}  // namespace patina::render
