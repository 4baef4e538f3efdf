#pragma once
// The `size = { distribution = "...", ... }` table of a pigment.

#include "patina/coating/table_reader.h"
#include "patina/optics/scattering/size_distribution.h"

namespace patina::coating {

// Throws Error(input) for parameters that are missing, out of range, or belong to another distribution.
optics::SizeDistribution read_size_distribution(const TableReader& reader);

}  // namespace patina::coating
