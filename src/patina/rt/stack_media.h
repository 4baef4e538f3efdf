#pragma once
// The media of a stack, with the kernels of its layers and the interfaces between them, shared by all Fourier orders.

#include <deque>
#include <optional>
#include <vector>

#include "patina/rt/adding.h"
#include "patina/rt/boundary.h"
#include "patina/rt/kernel.h"
#include "patina/rt/nodes.h"
#include "patina/rt/rough_boundary.h"
#include "patina/rt/rough_interface.h"
#include "patina/rt/solver.h"
#include "patina/rt/surface_boundary.h"

namespace patina::rt {

struct StackMedia {
    // `most_orders`: Fourier orders that will be asked for; 0: all. A stop throws Error(interrupted).
    StackMedia(const Problem& problem, std::vector<Ray> rays, int streams, int most_orders = 0,
               const CancelToken* cancel = nullptr);
    StackMedia(const StackMedia&) = delete;
    StackMedia& operator=(const StackMedia&) = delete;

    // Reflection of the base; empty when black.
    Eigen::MatrixXd base_reflection(int m, Components components) const;
    // The interface on top of layer k over what reflects `below`; there must be one.
    Added add_interface_of(int k, int m, Components components, const Eigen::MatrixXd& below) const;
    // A layer that scatters nothing at order m, in closed form.
    bool scatters(int k, int m) const {
        return m <= problem.layers[k].expansion.order() && problem.layers[k].single_scattering_albedo > 0.0;
    }
    LayerOperators<double> clear_layer(int k, double optical_thickness, Components components) const;

    const Problem& problem;
    std::vector<Ray> rays;
    Medium above;
    std::vector<Medium> layers;                  // of each layer
    std::deque<LayerKernel> kernels;             // of each layer
    std::vector<std::optional<Interface>> tops;  // of each layer; nothing where the indices match
    std::optional<RoughInterface> rough_top;
    std::optional<RoughBoundary> rough_base;
    std::optional<SurfaceBoundary> surface_base;
    int order = 0;  // the highest Fourier order that scattering or a rough surface can excite
};

// The groups of Stokes components that are solved together at order m.
std::vector<Components> component_groups(int m, bool scalar);

// What the quadrature says about its own quality, for Diagnostics.
void report_quadrature(const StackMedia& media, Diagnostics& diagnostics);

}  // namespace patina::rt
