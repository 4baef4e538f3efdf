#pragma once
// What the renderer asks of the world outside, as callbacks supplied by the caller (jobs), so that it knows no file
// format.

#include <functional>
#include <memory>
#include <string>

#include "patina/brdf/merl_table.h"
#include "patina/brdf/mueller_table.h"
#include "patina/core/bitmap.h"
#include "patina/core/mesh.h"
#include "patina/optics/refractive_index.h"
#include "patina/optics/scattering/spectral_medium.h"

namespace patina::render {

// Every callback that is left empty makes the scene that needs it an Error(not_built) or Error(input) naming the need.
// Paths are as the scene file gives them made absolute by the reader; errors thrown by a callback pass through.
struct SceneResources {
    // `kind` is the shape's plugin name: "obj" or "ply".
    std::function<std::shared_ptr<const TriangleMesh>(const std::string& path, const std::string& kind)> load_mesh;

    // `raw` true: the values are data (no decoding of sRGB).
    std::function<std::shared_ptr<const Bitmap>(const std::string& path, bool raw)> load_bitmap;

    // A BRDF table, or a recipe that is solved first.
    std::function<std::shared_ptr<const brdf::MuellerTable>(const std::string& path)> load_brdf_table;

    // A layer of a recipe as a medium; `layer` counts from the top, -1 is the topmost that scatters.
    std::function<std::shared_ptr<const optics::SpectralMedium>(const std::string& path, int layer)> load_medium;

    // Measured tables: a .pbsdf file, a MERL .binary file.
    std::function<std::shared_ptr<const brdf::HalfAngleTable>(const std::string& path)> load_half_angle_table;
    std::function<std::shared_ptr<const brdf::MerlTable>(const std::string& path)> load_merl_table;

    // The mesh whose materials and lamp are being built, null for other shapes: what `mesh_attribute` reads. The
    // builder of a scene sets it.
    std::shared_ptr<const TriangleMesh> mesh;

    // Optical constants by name or file; empty: the built-in library (optics/materials.h). Throws Error(input).
    std::function<optics::OpticalConstants(const std::string& name)> material;
};

}  // namespace patina::render
