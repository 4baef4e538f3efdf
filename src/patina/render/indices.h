#pragma once
// Refractive indices of a plugin: numbers, names of common media, sampled spectra, or optical constants of a material.

#include "patina/render/bsdf.h"

namespace patina::render {

// n of the property `name`: a number, a name (Mitsuba's list of media, or any built-in material: dispersive) or a
// spectrum.
Spectrum real_index(const Properties& node, const std::string& name, std::string_view fallback,
                    const BsdfBuilder& builder);

// n and k of a conductor: `material`, or the spectra `eta` and `k`. The default is copper; "none" is a perfect mirror.
struct ConductorIndex {
    Spectrum n, k;
};
ConductorIndex conductor_index(const Properties& node, const BsdfBuilder& builder);

}  // namespace patina::render
