#pragma once
// The scattering matrix F on a fine grid of angles: evaluation and exact sampling of the scattering angle.

#include <cstdint>
#include <vector>

#include "patina/optics/scattering/expansion_coefficients.h"
#include "patina/rt/monte_carlo/polarized_ray.h"
#include "patina/rt/monte_carlo/random.h"

namespace patina::rt::monte_carlo {

// F = [[a1,b1,0,0],[b1,a2,0,0],[0,0,a3,b2],[0,0,-b2,a4]] in the scattering plane; `density` is what the angle is
// sampled from.
struct ScatteringElements {
    double a1, a2, a3, a4, b1, b2, density;
};

template <int columns>
[[gnu::always_inline]] inline void apply(const ScatteringElements& f, StokesColumns<columns>& stokes) {
    for (int c = 0; c < columns; ++c) {
        const double i = stokes(0, c), q = stokes(1, c), u = stokes(2, c), v = stokes(3, c);
        stokes(0, c) = f.a1 * i + f.b1 * q;
        stokes(1, c) = f.b1 * i + f.a2 * q;
        stokes(2, c) = f.a3 * u + f.b2 * v;
        stokes(3, c) = f.a4 * v - f.b2 * u;
    }
}

// F at a cosine straight from the coefficients, by Legendre and Jacobi polynomials:
// d^l_02 = sqrt((l-2)!/(l+2)!) (1-x^2) P_l'', d^l_22 = ((1+x)/2)^2 P^(0,4)_{l-2}, d^l_2,-2 = ((1-x)/2)^2 P^(4,0)_{l-2}
// (Varshalovich, Moskalev & Khersonskii 1988, section 4.3.4). `density` is left at max(a1, 0).
ScatteringElements sum_expansion(const optics::ExpansionCoefficients& coefficients, double cosine);

// Nodes are equidistant in sqrt(1 - |cos|) in each hemisphere, dense where polynomials of high degree vary fastest;
// between them F is linear in the cosine. The sampled density is that very interpolant of a1, so that no weight arises
// from the table. Where a1 <= 0 (a truncated expansion) a small positive density stands in, and weights a1/density of
// either sign arise.
class ScatteringTable {
  public:
    explicit ScatteringTable(const optics::ExpansionCoefficients& coefficients, bool scalar = false);

    [[gnu::always_inline]] ScatteringElements at(double cosine) const {
        const double w = std::max(0.0, 1.0 - std::abs(cosine));
        const double u = std::sqrt(w) * cells_;
        const int cell = std::min(static_cast<int>(u), cells_ - 1);
        const double t = (w * cells_ * cells_ - static_cast<double>(cell) * cell) / (2.0 * cell + 1.0);
        return blend((cosine < 0.0 ? cells_ + 1 : 0) + cell, t);
    }

    // Draws the cosine with the density a1/2.
    double sample_cosine(RandomStream& random) const;

  private:
    [[gnu::always_inline]] ScatteringElements blend(int node, double t) const {
        const Node &f = nodes_[static_cast<std::size_t>(node)], &g = nodes_[static_cast<std::size_t>(node) + 1];
        const auto mix = [t](double a, double b) { return a + t * (b - a); };
        return {mix(f.a1, g.a1), mix(f.a2, g.a2), mix(f.a3, g.a3),          mix(f.a4, g.a4),
                mix(f.b1, g.b1), mix(f.b2, g.b2), mix(f.density, g.density)};
    }
    void normalize_and_build_alias();

    struct alignas(64) Node : ScatteringElements {};
    struct AliasCell {
        double threshold;
        std::int32_t other;
    };
    int cells_;                     // per hemisphere
    std::vector<Node> nodes_;       // [2][cells + 1]: forward from cos = 1 to 0, backward from cos = -1 to 0
    std::vector<AliasCell> alias_;  // [2 cells]
};

}  // namespace patina::rt::monte_carlo
