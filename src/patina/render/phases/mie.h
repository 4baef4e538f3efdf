#pragma once
// `mie`: spheres of a material in a binder, of one size or of a distribution of sizes, at every wavelength.
//
// Lorenz-Mie theory (optics/scattering/mie.h), tabulated every 10 nm and linear between: narrow resonances of large
// spheres of one size are smoothed over. Independent particles; for crowded ones, mixtures and packing take the medium
// `paint` of a recipe.

#include <memory>

#include "patina/render/phases/phase_table.h"

namespace patina::render {

// Any tabulated matrix: of Mie spheres by the plugin `mie`, of a recipe's layer by the medium `paint`.
struct MiePhase {
    std::shared_ptr<const PhaseTable> table;

    PhaseElements elements(const Wavelengths& w, float cosine) const { return table->elements(w, cosine); }
    float sample_cosine(const Wavelengths& w, int lane, float u) const { return table->sample_cosine(w, lane, u); }

    static PluginDescriptor describe();
    static MiePhase build(const Properties& node, const PhaseBuilder& builder);
};

}  // namespace patina::render
