#pragma once
// The stack as the random walk sees it, and what happens in it to light that does not scatter.

#include <optional>
#include <vector>

#include "patina/rt/monte_carlo/interface.h"
#include "patina/rt/monte_carlo/rough_top.h"
#include "patina/rt/monte_carlo/scattering_table.h"
#include "patina/rt/problem.h"

namespace patina::rt::monte_carlo {

struct StackLayer {
    double thickness;  // optical
    double albedo;
    double index;
    ScatteringTable table;
};

struct Stack {
    double index_above;
    std::vector<StackLayer> layers;
    Base base;
    bool scalar;
    std::optional<RoughTop> rough_top = std::nullopt;

    int size() const { return static_cast<int>(layers.size()); }
    // Of the medium above (layer = -1) or of a layer.
    double index(int layer) const { return layer < 0 ? index_above : layers[static_cast<std::size_t>(layer)].index; }
    double thickness(int layer) const { return layers[static_cast<std::size_t>(layer)].thickness; }
    // Interface between two transparent media, and the base when it is a metal.
    InterfaceGains interface(double cos_i, double n1, double n2) const;
    Gain mirror(double cos_i) const;
    bool has_metal() const { return std::holds_alternative<MetalBase>(base); }
    // Reflectance of the base when it is Lambertian, else 0.
    double lambertian_reflectance() const;
};

// A nearly conservative semi-infinite layer (1 - albedo < 1e-6), whose random walks have no finite mean length, ends on
// a Lambertian base at optical depth 20/(1-g) below the deepest requested level. That is the exact deep field:
// isotropic and unpolarized for albedo 1, transients decaying exponentially on both ways; below it the base has the
// spherical albedo of the rest, exp(-4 sqrt((1-w)/(3(1-wg)))) (asymptotic theory: Rozenberg 1962; van de Hulst 1980),
// whose error is of the order of 1-w.
Stack make_stack(const Problem& problem, bool scalar, double deepest_level);

// Unscattered light of one Snell invariant q = n sin(theta) in every layer: angles, attenuation, reflection at both
// faces.
class SpecularStack {
  public:
    SpecularStack(const Stack& stack, double snell_invariant);

    // Cosine of propagation in a layer; 0 where the wave would be evanescent.
    double mu(int layer) const { return mu_[static_cast<std::size_t>(layer)]; }

    // Where light is detected: at depth `tau` inside a layer, or above the stack (layer = -1), going up or down.
    struct Level {
        int layer;
        double tau;
        bool up;
    };
    // Detected radiance for unit radiance that leaves the top of each layer upward, or the bottom of each layer
    // downward, through all internal reflections but without scattering. shape [layers]
    struct Importance {
        std::vector<Gain> up_at_top, down_at_bottom;
    };
    Importance importance(const Level& level) const;

    // Flux through horizontal planes of a beam of unit flux entering from above: downward at the top of each layer,
    // upward at the bottom of each layer, with all internal reflections. shape [layers]
    struct Beam {
        std::vector<Gain> down_at_top, up_at_bottom;
    };
    Beam beam() const;

    double transmission(int layer) const { return attenuation_[static_cast<std::size_t>(layer)]; }

  private:
    using Channels = Eigen::Array3cd;  // pp, ss, cross: each is carried through the stack on its own
    struct Face {
        Channels reflect_down = Channels::Zero(), transmit_down = Channels::Zero();  // incident from above
        Channels reflect_up = Channels::Zero(), transmit_up = Channels::Zero();      // incident from below
    };
    static Channels channels(const Gain& g) { return {g.pp, g.ss, g.cross}; }

    const Stack& stack_;
    std::vector<double> mu_, attenuation_;  // [layers]
    std::vector<Face> faces_;               // [layers + 1]; the last is the base
};

}  // namespace patina::rt::monte_carlo
