// The reflection of a whole stack on the quadrature nodes.

#include <algorithm>
#include <cmath>

#include "patina/core/constants.h"
#include "patina/core/parallel.h"
#include "patina/rt/adding.h"
#include "patina/rt/single_scattering.h"
#include "patina/rt/stack.h"
#include "patina/rt/stack_media.h"

namespace patina::rt {

namespace {

// One Fourier order of one group of Stokes components.
struct GroupSolution {
    Eigen::MatrixXd reflection;  // in the variables of TransferSystem, on the rays of the medium above
    double energy_balance = 0.0;
};

// |1 - (R + T)| of the flux of unpolarized light through a conservative layer.
double flux_error(const TransferSystem<double>& system, const LayerOperators<double>& layer) {
    if (system.flux.size() == 0) return 0.0;
    Eigen::RowVectorXd out = system.flux.transpose() * layer.reflection;
    if (layer.transmission.size() > 0) out += system.flux.transpose() * layer.transmission;
    double worst = 0.0;
    for (int i = 0; i < system.size(); ++i)
        if (system.flux[i] > 0.0) worst = std::max(worst, std::abs(1.0 - out[i] / system.flux[i]));
    return worst;
}

constexpr double lost_in_rounding = 1e-14;

GroupSolution solve_group(const StackMedia& media, const LayerMethod& method, int m, Components components,
                          const CancelToken* cancel) {
    const Problem& problem = media.problem;
    const int count = static_cast<int>(problem.layers.size());
    GroupSolution result;
    Eigen::MatrixXd below = media.base_reflection(m, components);
    for (int k = count - 1; k >= 0; --k) {
        stop_if_requested(cancel);
        const Layer& layer = problem.layers[k];
        if (layer.optical_thickness > 0.0 && (media.scatters(k, m) || below.size() > 0)) {
            // Over a black base the transmitted light is lost; it is asked for at m = 0 only, to check the energy
            // balance.
            LayerOperators<double> operators;
            if (media.scatters(k, m)) {
                const TransferSystem<double> system = media.kernels[k].system(m, components);
                operators = method.solve(system, {layer.optical_thickness, m == 0 || below.size() > 0, cancel});
                result.energy_balance = std::max(result.energy_balance, flux_error(system, operators));
            } else {
                operators = media.clear_layer(k, layer.optical_thickness, components);
            }
            below = below.size() > 0 ? add_layer(operators, below).reflection : operators.reflection;
        }
        // Orders that nothing scatters see the base through clear layers only.
        if (m > 0 && below.size() > 0 && below.cwiseAbs().maxCoeff() < lost_in_rounding) below.resize(0, 0);
        if (media.tops[k]) below = media.add_interface_of(k, m, components, below).reflection;
    }
    if (below.size() == 0)
        below = Eigen::MatrixXd::Zero(media.above.size() * components.count, media.above.size() * components.count);
    result.reflection = std::move(below);
    return result;
}

// The rays of the medium above by ascending cosine.
std::vector<int> ascending(const Medium& medium) {
    std::vector<int> order(medium.size());
    for (int i = 0; i < medium.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](int a, int b) { return medium.mu[a] < medium.mu[b]; });
    return order;
}

// Blocks f(o, i) from the operator of a group: Delta R / (2 pi sqrt(w mu w' mu')), less the coherent light on the
// diagonal.
void store(const GroupSolution& group, Components components, const StackMedia& media, const std::vector<int>& order,
           const std::vector<optics::Mueller>& coherent, Eigen::MatrixXd& mode) {
    const int c = components.count, first = components.first, rays = static_cast<int>(order.size());
    for (int i = 0; i < rays; ++i)
        for (int column = 0; column < c; ++column)
            for (int o = 0; o < rays; ++o)
                for (int row = 0; row < c; ++row) {
                    double value = group.reflection(order[o] * c + row, order[i] * c + column);
                    if (first + row >= 2) value = -value;
                    if (o == i) value -= coherent[i](first + row, first + column);
                    mode(4 * o + first + row, 4 * i + first + column) +=
                        value / (2.0 * pi * media.above.scale[order[o]] * media.above.scale[order[i]]);
                }
}

void store_single(const SingleScattering& single, int m, const StackMedia& media, const std::vector<int>& order,
                  Eigen::MatrixXd& mode) {
    const Eigen::Index size = 4 * media.above.size();
    GroupSolution group{Eigen::MatrixXd::Zero(size, size), 0.0};
    single.add_reflection(m, group.reflection);
    const std::vector<optics::Mueller> nothing(order.size(), optics::Mueller::Zero());
    store(group, {0, 4}, media, order, nothing, mode);
}

}  // namespace

Reflection solve_reflection(const Problem& problem, const SolveOptions& options, const LayerMethod& method) {
    validate(problem);
    const Truncation truncation = truncate(problem, options.streams);
    const StackMedia media(truncation.scaled, quadrature_rays(problem, options.streams), options.streams,
                           options.most_fourier_orders, options.cancel);
    const SingleScattering single(media, truncation, cut(media.problem, {}).slabs, options.scalar);
    const std::vector<int> order = ascending(media.above);
    Reflection result;
    result.diagnostics.streams = options.streams;
    report_quadrature(media, result.diagnostics);
    report_truncation(truncation, result.diagnostics);
    std::vector<optics::Mueller> coherent;
    for (int i : order) {
        result.mu.push_back(media.above.mu[i]);
        result.weights.push_back(media.above.weight(i));
        coherent.push_back(coherent_reflection(media.problem, media.rays[media.above.rays[i]]));
    }

    // Solve as many orders at once as there are threads, until two in a row are negligible.
    double largest = 0.0;
    int negligible = 0;
    int orders = std::max(media.order, single.order()) + 1;
    if (options.most_fourier_orders > 0) orders = std::min(orders, options.most_fourier_orders);
    std::vector<double> balance(orders, 0.0);
    for (int begin = 0; begin < orders && negligible < 2;) {
        const int end = std::min(orders, begin + std::max(1, thread_count()));
        result.modes.resize(end);
        parallel_for(begin, end, [&](std::ptrdiff_t m) {
            stop_if_requested(options.cancel);
            Eigen::MatrixXd& mode = result.modes[m];
            mode = Eigen::MatrixXd::Zero(4 * order.size(), 4 * order.size());
            if (m <= single.order()) store_single(single, static_cast<int>(m), media, order, mode);
            if (m > media.order) return;
            for (const Components components : component_groups(static_cast<int>(m), options.scalar)) {
                const GroupSolution group = solve_group(media, method, static_cast<int>(m), components, options.cancel);
                balance[m] = std::max(balance[m], group.energy_balance);
                store(group, components, media, order, coherent, mode);
            }
        });
        for (; begin < end && negligible < 2; ++begin) {
            const double size = result.modes[begin].cwiseAbs().maxCoeff();
            largest = std::max(largest, size);
            negligible = size <= options.fourier_tolerance * largest ? negligible + 1 : 0;
        }
        result.modes.resize(begin);
        if (options.progress) options.progress(static_cast<double>(begin) / orders);
    }
    result.diagnostics.fourier_orders = static_cast<int>(result.modes.size());
    result.diagnostics.energy_balance = *std::max_element(balance.begin(), balance.end());
    return result;
}

}  // namespace patina::rt
