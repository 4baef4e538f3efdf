#pragma once
// The colour of a scene's light: what an eye in it would take for white.

#include <vector>

#include "patina/render/emitters.h"

namespace patina::render {

// XYZ of all emitters together, each by the power it sends into the scene (emitted_power()); zero in the dark. The
// geometry must be committed.
Vec3 white_of_emitters(const std::vector<Emitter>& emitters, const Geometry& geometry, const ColourMatching& matching);

}  // namespace patina::render
