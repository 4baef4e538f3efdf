#pragma once
// The media of a stack, with the kernels of its layers and the interfaces between them, shared by all Fourier orders.

#include <deque>
#include <optional>
#include <vector>

#include "patina/rt/boundary.h"
#include "patina/rt/kernel.h"
#include "patina/rt/nodes.h"
#include "patina/rt/solver.h"

namespace patina::rt {

struct StackMedia {
    StackMedia(const Problem& problem, std::vector<Ray> rays);
    StackMedia(const StackMedia&) = delete;
    StackMedia& operator=(const StackMedia&) = delete;

    const Medium& of_layer(int k) const { return layers[k]; }

    const Problem& problem;
    std::vector<Ray> rays;
    Medium above;
    std::vector<Medium> layers;                  // of each layer
    std::deque<LayerKernel> kernels;             // of each layer
    std::vector<std::optional<Interface>> tops;  // of each layer; nothing where the indices match
    int order = 0;                               // the highest Fourier order that scattering can excite
};

// The groups of Stokes components that are solved together at order m.
std::vector<Components> component_groups(int m, bool scalar);

// What the quadrature says about its own quality, for Diagnostics.
void report_quadrature(const StackMedia& media, Diagnostics& diagnostics);

}  // namespace patina::rt
