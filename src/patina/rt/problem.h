#pragma once
// The plane-parallel radiative transfer problem: what a solver is given. It knows no paint and no particle.

#include <complex>
#include <optional>
#include <variant>
#include <vector>

#include "patina/optics/scattering/expansion_coefficients.h"

namespace patina::rt {

// A homogeneous layer. Optical thickness may be infinite for the lowest layer of a stack.
struct Layer {
    double optical_thickness = 0.0;         // extinction, >= 0
    double single_scattering_albedo = 0.0;  // 0 .. 1
    optics::ExpansionCoefficients expansion;
    double refractive_index = 1.0;  // of the host, real; light refracts wherever neighbouring indices differ
};

// A surface of small facets that are smooth themselves.
enum class FacetDistribution { ggx, beckmann };
struct RoughSurface {
    double alpha = 0.0;  // width of the facets' slopes, in (0, 1]
    FacetDistribution distribution = FacetDistribution::ggx;
};

struct BlackBase {};
struct LambertianBase {
    double reflectance = 0.0;  // 0 .. 1, depolarizing
};
struct MetalBase {
    std::complex<double> refractive_index;                 // n + i k; against the lowest layer's index
    std::optional<RoughSurface> roughness = std::nullopt;  // a smooth mirror without
};
using Base = std::variant<BlackBase, LambertianBase, MetalBase>;

// Layers from top to bottom. A top interface exists where refractive_index_above differs from the first layer's index;
// an index-matched top has them equal (directions and angles are then those in the host).
struct Problem {
    double refractive_index_above = 1.0;
    std::vector<Layer> layers;  // at least one
    Base base = BlackBase{};
};

}  // namespace patina::rt
