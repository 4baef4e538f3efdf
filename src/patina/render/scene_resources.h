#pragma once
// What the renderer asks of the world outside: files, materials and colour, as callbacks supplied by the caller (jobs),
// so that the renderer knows no file format and no table of colour.

#include <functional>
#include <memory>
#include <string>

#include <Eigen/Dense>

#include "patina/brdf/mueller_table.h"
#include "patina/core/bitmap.h"
#include "patina/core/mesh.h"
#include "patina/core/properties.h"
#include "patina/optics/refractive_index.h"

namespace patina::render {

// Any quantity against vacuum wavelength in nm, on 360 .. 830 nm.
using SpectrumFunction = std::function<double(double wavelength_nm)>;

// Smooth reflectance S(x) = 1/2 + x / (2 sqrt(1 + x^2)), x = (c0 w + c1) w + c2 with w in nm (Jakob & Hanika 2019, eq.
// 3-4).
using SigmoidCoefficients = Eigen::Vector3d;

// Every callback that is left empty makes the scene that needs it an Error(not_built) or Error(input) naming the need.
// Paths are as the scene file gives them made absolute by the reader; errors thrown by a callback pass through.
struct SceneResources {
    // `kind` is the shape's plugin name: "obj" or "ply".
    std::function<std::shared_ptr<const TriangleMesh>(const std::string& path, const std::string& kind)> load_mesh;

    // `raw` true: the values are data (no decoding of sRGB).
    std::function<std::shared_ptr<const Bitmap>(const std::string& path, bool raw)> load_bitmap;

    // A BRDF table, or a recipe that is solved first.
    std::function<std::shared_ptr<const brdf::MuellerTable>(const std::string& path)> load_brdf_table;

    // Optical constants of a built-in material or of an n,k file. Mitsuba's element names ("Au", "Al", "Cu", ...)
    // included.
    std::function<optics::OpticalConstants(const std::string& name)> material;

    // Upsampling of a linear sRGB reflectance, components in [0, 1].
    std::function<SigmoidCoefficients(const Eigen::Vector3d& rgb)> rgb_reflectance;

    // CIE 1931 2-degree colour matching functions xbar, ybar, zbar (any common scale; it is normalized here so that the
    // uniform unit spectrum has Y = 1).
    std::function<Eigen::Vector3d(double wavelength_nm)> cie_xyz;

    // Relative spectral power of CIE D65 (any scale), which <rgb> emitters multiply.
    SpectrumFunction illuminant_d65;
};

}  // namespace patina::render
