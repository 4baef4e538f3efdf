#include "patina/rt/stack_media.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace patina::rt {

StackMedia::StackMedia(const Problem& p, std::vector<Ray> all_rays, int streams, int most_orders,
                       const CancelToken* cancel)
    : problem(p), rays(std::move(all_rays)) {
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
            tops.emplace_back(interface_between(rays, upper, layers[k]));
    }

    if (problem.has_rough_top()) {
        rough_top.emplace(*problem.top_roughness, rays, above, layers.front(), streams, most_orders, cancel);
        order = std::max(order, rough_top->order());
    }
    if (const auto* metal = std::get_if<MetalBase>(&problem.base); metal && metal->roughness) {
        rough_base.emplace(*metal->roughness, layers.back(), metal->refractive_index, streams, cancel);
        order = std::max(order, rough_base->order());
    }
    if (const auto* known = std::get_if<SurfaceBase>(&problem.base)) {
        surface_base.emplace(*known->surface, layers.back());
        order = std::max(order, surface_base->order());
    }
}

Eigen::MatrixXd StackMedia::base_reflection(int m, Components components) const {
    if (rough_base) return rough_base->scattering(m, components);
    Eigen::MatrixXd result = patina::rt::base_reflection(problem.base, layers.back(), m, components);
    if (surface_base) result += surface_base->scattering(m, components);
    return result;
}

Added StackMedia::add_interface_of(int k, int m, Components components, const Eigen::MatrixXd& below) const {
    if (k == 0 && rough_top) return add_rough_interface(rough_top->operators(m, components), below);
    return add_interface(*tops[k], below, components, layers[k].size(), k > 0);
}

LayerOperators<double> StackMedia::clear_layer(int k, double optical_thickness, Components components) const {
    const int c = components.count;
    const Eigen::Index n = static_cast<Eigen::Index>(layers[k].size()) * c;
    LayerOperators<double> result{Eigen::MatrixXd::Zero(n, n), {}};
    if (std::isinf(optical_thickness)) return result;
    result.transmission = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i) result.transmission(i, i) = std::exp(-optical_thickness / layers[k].mu[i / c]);
    return result;
}

std::vector<Components> component_groups(int m, bool scalar) {
    if (scalar) return {{0, 1}};
    if (m == 0) return {{0, 2}, {2, 2}};
    return {{0, 4}};
}

void report_quadrature(const StackMedia& media, Diagnostics& diagnostics) {
    constexpr double acceptable = 1e-3;
    constexpr double unbalanced = 0.02;  // given back anyway
    constexpr double unresolved = 0.5;   // facets that shadow each other lose up to a fifth themselves
    for (std::size_t k = 0; k < media.kernels.size(); ++k) {
        const double error = media.kernels[k].quadrature_error();
        if (error < acceptable || media.problem.layers[k].single_scattering_albedo == 0.0) continue;
        diagnostics.converged = false;
        diagnostics.notes.push_back(fmt::format(
            "layer {}: {} streams integrate its phase function (order {}) with an error of {:.1e}; take more", k,
            diagnostics.streams, media.problem.layers[k].expansion.order(), error));
    }
    if (media.surface_base && media.surface_base->correction() > unbalanced) {
        diagnostics.converged = false;
        diagnostics.notes.push_back(
            fmt::format("base: {} streams integrate its BRDF with an error of {:.1e}; take more", diagnostics.streams,
                        media.surface_base->correction()));
    }
    if (media.rough_top && media.rough_top->correction() > unresolved) {
        diagnostics.converged = false;
        diagnostics.notes.push_back(
            fmt::format("interface: {} streams miss {:.0f} % of its rough reflection; take more", diagnostics.streams,
                        100.0 * media.rough_top->correction()));
    }
    if (!media.rough_base || media.rough_base->correction() < unresolved) return;
    diagnostics.converged = false;
    diagnostics.notes.push_back(fmt::format("base: {} streams miss {:.0f} % of its rough reflection; take more",
                                            diagnostics.streams, 100.0 * media.rough_base->correction()));
}

}  // namespace patina::rt
