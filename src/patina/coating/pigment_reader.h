#pragma once
// The [[layers.pigments]] of a layer: what the particles are, and how much of the film they fill.

#include <vector>

#include "patina/coating/material_reader.h"
#include "patina/coating/recipe.h"

namespace patina::coating {

// The keys of a pigment that say how much of it there is; a pigment has exactly one.
inline constexpr std::string_view concentration_keys[] = {"volume_fraction", "pvc_percent", "weight_percent",
                                                          "number_density_per_um3"};

// The pigments of the layer that `layer` reads. Throws Error(input) with the place for what is missing, given twice or
// impossible, and for more particles than fit.
std::vector<Pigment> read_pigments(const TableReader& layer, const Context& context);

}  // namespace patina::coating
