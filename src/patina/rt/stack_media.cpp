#include "patina/rt/stack_media.h"

#include <fmt/format.h>

namespace patina::rt {

StackMedia::StackMedia(const Problem& p, std::vector<Ray> all_rays) : problem(p), rays(std::move(all_rays)) {
    above = medium_of(rays, problem.refractive_index_above);
    for (const Layer& layer : problem.layers) layers.push_back(medium_of(rays, layer.refractive_index));
    for (std::size_t k = 0; k < layers.size(); ++k) {
        const Layer& layer = problem.layers[k];
        kernels.emplace_back(layer, layers[k]);
        if (layer.single_scattering_albedo > 0.0 && layer.optical_thickness > 0.0)
            order = std::max(order, layer.expansion.order());
        const Medium& upper = k > 0 ? layers[k - 1] : above;
        if (upper.index == layers[k].index)
            tops.emplace_back();
        else
            tops.emplace_back(interface_between(upper, layers[k]));
    }
}

std::vector<Components> component_groups(int m, bool scalar) {
    if (scalar) return {{0, 1}};
    if (m == 0) return {{0, 2}, {2, 2}};
    return {{0, 4}};
}

void report_quadrature(const StackMedia& media, Diagnostics& diagnostics) {
    constexpr double acceptable = 1e-3;
    for (std::size_t k = 0; k < media.kernels.size(); ++k) {
        const double error = media.kernels[k].quadrature_error();
        if (error < acceptable || media.problem.layers[k].single_scattering_albedo == 0.0) continue;
        diagnostics.converged = false;
        diagnostics.notes.push_back(fmt::format(
            "layer {}: {} streams integrate its phase function (order {}) with an error of {:.1e}; take more", k,
            diagnostics.streams, media.problem.layers[k].expansion.order(), error));
    }
}

}  // namespace patina::rt
