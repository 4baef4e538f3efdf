#pragma once
// The plane-parallel radiative transfer problem: what a solver is given. It knows no paint and no particle.

#include <algorithm>
#include <complex>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "patina/optics/scattering/expansion_coefficients.h"
#include "patina/optics/stokes.h"

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

// What a surface reflects, known by its BRDF. Directions and radiances are those of the lowest layer's medium.
class SurfaceReflection {
  public:
    virtual ~SurfaceReflection() = default;
    // Highest Fourier order of the BRDF.
    virtual int order() const = 0;
    // Order m of the BRDF without its delta part, 1/sr: 4 x 4 blocks (o, i) with the meaning of Reflection::modes
    // (rt/solver.h), from and to the directions of these cosines.
    virtual Eigen::MatrixXd mode(int m, const Eigen::VectorXd& mu) const = 0;
    // Directional-hemispherical reflectance of unpolarized light, without the delta part.
    virtual double albedo(double mu) const = 0;
    // The delta part along the mirror direction.
    virtual optics::Mueller specular(double mu) const = 0;
};
struct SurfaceBase {
    std::shared_ptr<const SurfaceReflection> surface;  // not null
};
using Base = std::variant<BlackBase, LambertianBase, MetalBase, SurfaceBase>;

// Layers from top to bottom. A top interface exists where refractive_index_above differs from the first layer's index;
// an index-matched top has them equal (directions and angles are then those in the host).
struct Problem {
    double refractive_index_above = 1.0;
    std::vector<Layer> layers;  // at least one
    Base base = BlackBase{};
    // Facets of the top interface; smooth without. It means nothing where the top is index matched.
    std::optional<RoughSurface> top_roughness = std::nullopt;

    // Highest order of the layers' expansions.
    int order() const {
        int highest = 0;
        for (const Layer& layer : layers) highest = std::max(highest, layer.expansion.order());
        return highest;
    }
    bool has_rough_top() const { return top_roughness && layers.front().refractive_index != refractive_index_above; }
};

}  // namespace patina::rt
