#pragma once
// Which white a picture of a scene is meant to be seen with.

#include "patina/core/properties.h"

namespace patina::render {

// Is the scene lit by what stands for daylight D65: colours given as rgb, surroundings from a picture, or a spectrum
// whose chromaticity is nearer to D65's than to that of a uniform one? Looks at the scene's tree and marks nothing.
bool lit_by_daylight(const Properties& scene);

}  // namespace patina::render
