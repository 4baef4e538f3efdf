#pragma once
// What single scattering lacks after truncation, put back exactly (the TMS correction of Nakajima & Tanaka 1988).
//
// Light that is scattered once by the lacking part of a layer's matrix and otherwise only refracted, attenuated and
// mirrored by smooth interfaces and a smooth metal base, with all its reflections among them, in closed form. Variables
// are those of TransferSystem, Fourier order by order.

#include <vector>

#include "patina/rt/slabs.h"
#include "patina/rt/stack_media.h"
#include "patina/rt/truncation.h"

namespace patina::rt {

// Unscattered light of one ray in each slab, per unit of light of that ray coming down above the stack.
struct RayLight {
    std::vector<optics::Mueller> down, up;  // at the slab's top, at its bottom
};

// Light of one ray at each level of a stack of slabs.
struct RayLevels {
    std::vector<Eigen::Matrix<double, 4, 2>> down, up;  // level 0 upward is above the top interface
};

// One ray's way through the slabs of a stack when nothing scatters.
class RayPath {
  public:
    RayPath(const Problem& problem, const std::vector<Slab>& slabs, const Ray& ray, bool scalar);

    RayLight unscattered() const;
    // Levels that slabs emitting that much, down at their bottom and up at their top, light up.
    RayLevels lit_by(const RayLevels& emission) const;

  private:
    struct Top {  // of a slab; the identity where there is no interface
        optics::Mueller reflection_below, transmission_down, transmission_up;
    };
    optics::Mueller downward(std::size_t p) const;

    std::vector<Top> tops_;
    std::vector<double> attenuation_;
    std::vector<optics::Mueller> below_, bottom_;  // reflection at a slab's top (under its interface), at its bottom
};

class SingleScattering {
  public:
    // All must outlive this; `media` are those of truncation.scaled.
    SingleScattering(const StackMedia& media, const Truncation& truncation, std::vector<Slab> slabs, bool scalar);

    // 0 when there is nothing to put back.
    int order() const { return truncation_.order; }
    // Adds to the reflection of all four components on the rays of the medium above.
    void add_reflection(int m, Eigen::MatrixXd& reflection) const;
    // Levels lit by the one beam ray carrying `incident` = (I,Q) and (U,V) apart, at each view ray (-1 quadrature rays:
    // empty), by position in the list of rays.
    std::vector<RayLevels> field(int m, const Eigen::Matrix<double, 4, 2>& incident) const;

  private:
    const StackMedia& media_;
    const Truncation& truncation_;
    std::vector<Slab> slabs_;
    bool scalar_;
    std::vector<RayPath> paths_;    // of each ray
    std::vector<RayLight> lights_;  // of each ray
};

}  // namespace patina::rt
