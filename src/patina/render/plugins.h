#pragma once
// The registry of everything a scene file can name, and the checks that follow from it.

#include "patina/core/properties.h"
#include "patina/render/render.h"

namespace patina::render {

// Throws Error(input) with the nearest legal name when the node's type is no plugin of its category.
const PluginDescriptor& expect_plugin(const Properties& node);

// Throws Error(input) for the first property or child of the node that was never asked for. Call when it is built.
void expect_known_properties(const Properties& node);

}  // namespace patina::render
