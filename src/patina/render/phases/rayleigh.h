#pragma once
// `rayleigh`: particles much smaller than the wavelength, with the depolarization of those that are not isotropic.
//
// Hansen & Travis (1974), Space Sci. Rev. 16, 527, eqs 2.15-2.16: the dipole's matrix in the share
// D = (1 - rho)/(1 + rho/2), isotropic unpolarized light in the rest; circular polarization keeps (1 - 2 rho)/(1 - rho)
// of the dipole's. rho is the depolarization factor: of natural light scattered at 90 degrees the ratio of the weaker
// to the stronger linear component; 0 a perfect dipole, 0.028 air (Bates 1984), 1/2 randomly oriented needles. The
// dependence of the cross section on wavelength is the medium's.

#include "patina/render/phase.h"

namespace patina::render {

struct RayleighPhase {
    float dipole = 1;    // share D
    float circular = 1;  // (1 - 2 rho) / (1 - rho)

    PhaseElements elements(const Wavelengths&, float cosine) const {
        const float c2 = cosine * cosine;
        PhaseElements f;
        f.kind = dipole == 1 ? PhaseElements::Kind::sphere : PhaseElements::Kind::general;
        f.a2 = splat(0.75f * dipole * (1 + c2));
        f.a1 = f.a2 + (1 - dipole);
        f.b1 = splat(-0.75f * dipole * (1 - c2));
        f.a3 = splat(1.5f * dipole * cosine);
        f.a4 = f.a3 * circular;
        f.b2 = splat(0);
        return f;
    }
    float sample_cosine(const Wavelengths&, int, float u) const {
        if (u >= dipole) return 1 - 2 * std::min(1.0f, (u - dipole) / (1 - dipole));
        // The root of (c^3 + 3 c + 4) / 8 = u / dipole (Frisvad 2011, J. Opt. Soc. Am. A 28, 2436).
        const float z = 4 * u / dipole - 2;
        const float a = std::cbrt(z + std::sqrt(z * z + 1));
        return std::clamp(a - 1 / a, -1.0f, 1.0f);
    }

    static PluginDescriptor describe();
    static RayleighPhase build(const Properties& node, const PhaseBuilder& builder);
};

}  // namespace patina::render
