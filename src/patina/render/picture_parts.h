#pragma once
// Pictures of parts of the light that add up to the whole picture to the last bit.
//
// Floating-point sums depend on their order and lose bits, unless all terms are multiples of one power of two and every
// partial sum has no more than 24 digits over it. So each value of the picture, in each part, is rounded to a multiple
// of a step fixed by the sum of the parts' magnitudes: 2^-22 of the next power of two above it. The whole is then the
// exact sum, and differs from the unrounded one by less than a part in 10^6.

#include <vector>

#include "patina/core/stokes_image.h"

namespace patina::render {

// Rounds the spectral and rgb values of all parts, pictures of one format, as said above. At most 2^20 parts.
void align_parts(std::vector<StokesImage>& parts);

// Adds the spectral and rgb values of a part, value by value.
void add_part(StokesImage& sum, const StokesImage& part);

}  // namespace patina::render
