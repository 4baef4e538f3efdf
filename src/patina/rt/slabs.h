#pragma once
// Layers cut at the levels where light is wanted.

#include <vector>

#include "patina/rt/problem.h"

namespace patina::rt {

// A part of a layer between two levels. Level p lies at the top of slab p; level 0 below the top interface, the others
// at the bottom of slab p-1, above an interface that may be there.
struct Slab {
    int layer;
    double optical_thickness;
};

struct Levels {
    std::vector<Slab> slabs;
    std::vector<int> of_depth;  // level of each requested depth
    int layer_at(int level) const { return slabs[level > 0 ? level - 1 : 0].layer; }
};

// Cuts the layers at the requested optical depths; none leaves every layer whole.
Levels cut(const Problem& problem, const std::vector<double>& depths);

}  // namespace patina::rt
