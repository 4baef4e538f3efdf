#pragma once
// Shapes from their nodes of the scene file into the scene's geometry.

#include "patina/core/properties.h"
#include "patina/render/geometry.h"
#include "patina/render/scene_resources.h"

namespace patina::render {

// Appends the shape a node describes (without its material and emitter); returns its index in geometry.shapes.
// In a group (geometry.h) it stays in its own space. Throws Error(input) for degenerate or not finite geometry.
int append_shape(const Properties& node, const SceneResources& resources, Geometry& geometry, int group = -1);

}  // namespace patina::render
