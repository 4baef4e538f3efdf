#pragma once
// A paint recipe: what a coating is made of. The file format is TOML; its keys are declared in recipe_keys.cpp.

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "patina/coating/table_base.h"
#include "patina/core/error.h"
#include "patina/optics/refractive_index.h"
#include "patina/optics/scattering/expansion_coefficients.h"
#include "patina/optics/scattering/external_particles.h"
#include "patina/optics/scattering/size_distribution.h"
#include "patina/rt/problem.h"
#include "patina/spectral/spectrum.h"

namespace patina::coating {

// Homogeneous spheres; with `extraordinary` randomly oriented uniaxial ones whose ordinary ray sees `material`.
struct Spheres {
    optics::OpticalConstants material;
    optics::SizeDistribution size;
    std::optional<optics::OpticalConstants> extraordinary;
};

struct Pigment {
    double volume_fraction = 0.0;  // of the dry film
    std::variant<Spheres, optics::ExternalParticles> particles;

    const std::string& name() const;  // of the material or of the file
};

// How neighbouring particles' fields interfere (docs/theory.md).
enum class Packing { automatic, percus_yevick, independent };

// A layer by composition; its binder's refractive index is what light refracts into.
struct Composition {
    double thickness_um = 0.0;
    optics::OpticalConstants binder;
    std::vector<Pigment> pigments;
    Packing packing = Packing::automatic;
    std::optional<double> volume_solids;  // dry volume / volume of the wet paint, (0, 1]
};

// A layer in optical terms, the same at every wavelength.
struct OpticalLayer {
    double optical_thickness = 0.0;  // may be infinite for the lowest layer
    double single_scattering_albedo = 0.0;
    optics::ExpansionCoefficients expansion;
    double refractive_index = 1.0;
};

struct RecipeLayer {
    std::string name;
    std::variant<Composition, OpticalLayer> content;
};

struct NoBase {};
struct LambertianBase {
    spectral::Spectrum reflectance;  // 0 .. 1
};
struct MetalBase {
    optics::OpticalConstants material;
    std::optional<rt::RoughSurface> roughness;  // a mirror without
};

struct Recipe {
    std::string title;
    optics::Extrapolation extrapolation = optics::Extrapolation::refuse;
    bool has_interface = false;  // a Fresnel interface to air on top; else the top is index matched
    std::optional<rt::RoughSurface> interface_roughness;  // of that interface; smooth without
    std::vector<RecipeLayer> layers;  // top to bottom, at least one; those of a base recipe are the last
    std::variant<NoBase, LambertianBase, MetalBase, TableBase> base;
    std::string text;  // as read, after --set, for provenance
    std::string path;

    // True when no layer and no base depends on wavelength.
    bool is_wavelength_independent() const;
};

// Reads a recipe; `settings` are "layers.0.thickness_um=30" assignments made before it is checked. File names in the
// recipe are relative to its folder. Throws Error(input) with file:line:column, the reason and the nearest legal value.
Recipe read_recipe(const std::filesystem::path& path, const std::vector<std::string>& settings = {});

// The same from text; `name` stands for the file in messages.
Recipe parse_recipe(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                    const std::vector<std::string>& settings = {});

}  // namespace patina::coating
