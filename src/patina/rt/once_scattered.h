#pragma once
// Light scattered once, for whoever wants it in closed form.
//
// The single scattering of large particles has features of a degree (glory, rainbow) that neither the nodes nor the
// Fourier modes of a table follow, while light scattered twice or more is smooth. The modes of the truncated problem
// less its once scattered light, plus once scattered light of the whole phase function, are the BRDF with the
// correction of Nakajima & Tanaka (1988).

#include <vector>

#include "patina/rt/solver.h"
#include "patina/rt/truncation.h"

namespace patina::rt {

// One scattering layer of the scaled stack. Light that comes down on the stack as a unit Stokes vector goes down under
// the layer's top as `down` and up above its bottom as Delta^-1 `up`, Delta = diag(1,1,-1,-1), without having been
// scattered; in radiant flux through horizontal planes.
struct OnceScatteredLayer {
    double index_ratio = 1.0;                  // refractive index over that above the stack
    double optical_thickness = 0.0;            // scaled
    optics::ExpansionCoefficients scattering;  // omega/(1 - omega f) S_l: of the whole matrix, per scaled optical depth
    std::vector<optics::Mueller> down, up;     // one a cosine asked for
};

// `mu`: cosines above the stack, (0, 1].
std::vector<OnceScatteredLayer> once_scattered(const Truncation& truncation, const std::vector<double>& mu);

// Takes light scattered once, with what the truncated matrices kept, from a reflection of truncation.scaled with that
// many streams. A stop throws Error(interrupted).
void subtract_once_scattered(const Truncation& truncation, int streams, Reflection& reflection,
                             const CancelToken* cancel = nullptr);

}  // namespace patina::rt
