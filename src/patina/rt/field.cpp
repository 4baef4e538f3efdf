// Stokes radiances at exact directions and depths.

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/rt/adding.h"
#include "patina/rt/single_scattering.h"
#include "patina/rt/stack.h"
#include "patina/rt/stack_media.h"

namespace patina::rt {

namespace {

// Directions nearer to the horizon stand for it: the radiance there is the source function, and changes by this much at
// most.
constexpr double smallest_cosine = 1e-6;

void validate_request(const Problem& problem, const FieldRequest& request) {
    const auto bad = [](const std::string& text, std::string_view why, std::string_view hint) {
        return input_error(SourceLocation{}, text, why, hint);
    };
    if (!(request.mu_i > 0.0 && request.mu_i <= 1.0))
        throw bad(fmt::format("cosine of incidence {}", request.mu_i), "the beam must come from above", "in (0, 1]");
    if (!request.incident.allFinite())
        throw bad("the incident Stokes vector has an element that is not a number", "", "");
    for (double mu : request.mu_o)
        if (!(mu >= 0.0 && mu <= 1.0))
            throw bad(fmt::format("view cosine {}", mu), "both hemispheres are always given", "in [0, 1]");
    for (double phi : request.phi)
        if (!std::isfinite(phi)) throw bad("an azimuth is not a number", "", "");
    double total = 0.0;
    for (const Layer& layer : problem.layers) total += layer.optical_thickness;
    for (std::size_t d = 0; d < request.optical_depths.size(); ++d) {
        const double depth = request.optical_depths[d];
        if (!(depth >= 0.0 && std::isfinite(depth) && depth <= total * (1.0 + 1e-12)))
            throw bad(fmt::format("optical depth {}", depth),
                      fmt::format("the stack has an optical thickness of {}", total), "");
    }
}

// What one Fourier order contributes: [depth][direction] Stokes amplitudes for the incident (I,Q) and (U,V) parts.
struct ModeField {
    std::vector<std::vector<Eigen::Matrix<double, 4, 2>>> upward, downward;
    double size = 0.0;
};

class FieldSolver {
  public:
    FieldSolver(const StackMedia& media, const FieldRequest& request, const Levels& levels, const LayerMethod& method,
                const SingleScattering& single, const SolveOptions& options)
        : media_(media),
          request_(request),
          levels_(levels),
          method_(method),
          single_(single),
          scalar_(options.scalar),
          cancel_(options.cancel) {}

    ModeField solve(int m) const;

  private:
    struct Sweep {
        std::vector<Added> slab, interface;  // of each slab, and of the interface at its top
        Added top;
    };
    void solve_group(int m, Components components, ModeField& result) const;
    void add_single(int m, ModeField& result) const;
    std::vector<Added> sweep_up(int m, Components components, std::vector<Eigen::MatrixXd>& below,
                                std::vector<Added>& interfaces) const;
    Eigen::MatrixXd incident(Components components) const;
    void pick(const Medium& medium, const Eigen::MatrixXd& light, Components components, bool upward,
              std::vector<Eigen::Matrix<double, 4, 2>>& out) const;

    const StackMedia& media_;
    const FieldRequest& request_;
    const Levels& levels_;
    const LayerMethod& method_;
    const SingleScattering& single_;
    bool scalar_;
    const CancelToken* cancel_;
};

// From the base up: the reflection below each level, and what each slab and interface passes down.
std::vector<Added> FieldSolver::sweep_up(int m, Components components, std::vector<Eigen::MatrixXd>& below,
                                         std::vector<Added>& interfaces) const {
    const int count = static_cast<int>(levels_.slabs.size());
    std::vector<Added> slabs(count);
    interfaces.resize(count);
    below.resize(count + 1);
    below[count] = media_.base_reflection(m, components);
    std::map<std::pair<int, double>, LayerOperators<double>> solved;
    for (int p = count - 1; p >= 0; --p) {
        stop_if_requested(cancel_);
        const auto [k, thickness] = levels_.slabs[p];
        if (thickness > 0.0) {
            auto [found, is_new] = solved.try_emplace({k, thickness});
            if (is_new)
                found->second = media_.scatters(k, m)
                                    ? method_.solve(media_.kernels[k].system(m, components), {thickness, true, cancel_})
                                    : media_.clear_layer(k, thickness, components);
            slabs[p] = add_layer(found->second, below[p + 1]);
        } else {
            const Eigen::Index n = static_cast<Eigen::Index>(media_.layers[k].size()) * components.count;
            slabs[p] = {below[p + 1], Eigen::MatrixXd::Identity(n, n)};
        }
        below[p] = slabs[p].reflection;
        const bool starts_layer = p == 0 || levels_.slabs[p - 1].layer != k;
        if (starts_layer && media_.tops[k]) {
            interfaces[p] = media_.add_interface_of(k, m, components, below[p]);
            if (p > 0) below[p] = interfaces[p].reflection;
        }
    }
    return slabs;
}

// The beam in the medium above, (I,Q) and (U,V) apart: pi/(2 pi) of its flux through the horizontal is the amplitude of
// every order.
Eigen::MatrixXd FieldSolver::incident(Components components) const {
    const Medium& above = media_.above;
    Eigen::MatrixXd light = Eigen::MatrixXd::Zero(above.size() * components.count, 2);
    for (int i = 0; i < above.size(); ++i)
        if (above.roles[i] == Role::beam)
            for (int c = 0; c < components.count; ++c)
                light(i * components.count + c, (components.first + c) / 2) =
                    0.5 * above.mu[i] * request_.incident[components.first + c];
    return light;
}

// Radiances n^2 y of the view rays of a medium.
void FieldSolver::pick(const Medium& medium, const Eigen::MatrixXd& light, Components components, bool upward,
                       std::vector<Eigen::Matrix<double, 4, 2>>& out) const {
    if (light.size() == 0) return;
    const int c = components.count;
    std::size_t next = 0;
    for (int i = 0; i < medium.size(); ++i) {
        const Ray& ray = media_.rays[medium.rays[i]];
        if (ray.role != Role::view || ray.index != medium.index) continue;
        for (int row = 0; row < c; ++row) {
            const double sign = upward && components.first + row >= 2 ? -1.0 : 1.0;
            out[next].row(components.first + row) += sign * medium.index * medium.index * light.row(i * c + row);
        }
        ++next;
    }
}

void FieldSolver::solve_group(int m, Components components, ModeField& result) const {
    std::vector<Eigen::MatrixXd> below;
    std::vector<Added> interfaces;
    const std::vector<Added> slabs = sweep_up(m, components, below, interfaces);

    // Carry the beam down level by level.
    const int count = static_cast<int>(slabs.size());
    std::vector<Eigen::MatrixXd> down(count + 1), up(count + 1);
    const Eigen::MatrixXd beam = incident(components);
    const bool surface = interfaces[0].downward.size() > 0;
    down[0] = surface ? Eigen::MatrixXd(interfaces[0].downward * beam) : beam;
    const Eigen::MatrixXd& top = surface ? interfaces[0].reflection : below[0];
    Eigen::MatrixXd leaving = top.size() > 0 ? Eigen::MatrixXd(top * beam) : Eigen::MatrixXd();
    Eigen::MatrixXd light = down[0];
    for (int p = 0; p < count; ++p) {
        if (p > 0 && interfaces[p].downward.size() > 0) light = interfaces[p].downward * light;
        if (slabs[p].downward.size() == 0) break;  // infinitely thick
        light = slabs[p].downward * light;
        down[p + 1] = light;
        if (below[p + 1].size() > 0) up[p + 1] = below[p + 1] * light;
    }

    for (std::size_t d = 0; d < levels_.of_depth.size(); ++d) {
        const int p = levels_.of_depth[d];
        const Medium& medium = media_.layers[levels_.layer_at(p)];
        pick(p == 0 ? media_.above : medium, p == 0 ? leaving : up[p], components, true, result.upward[d]);
        pick(medium, down[p], components, false, result.downward[d]);
    }
}

void FieldSolver::add_single(int m, ModeField& result) const {
    const int count = static_cast<int>(levels_.slabs.size());
    const Medium& above = media_.above;
    const Eigen::MatrixXd beam = incident({0, scalar_ ? 1 : 4});
    Eigen::Matrix<double, 4, 2> light = Eigen::Matrix<double, 4, 2>::Zero();
    for (int i = 0; i < above.size(); ++i)
        if (above.roles[i] == Role::beam) {
            const int c = scalar_ ? 1 : 4;
            light.topRows(c) = beam.middleRows(i * c, c);
        }
    const std::vector<RayLevels> lit = single_.field(m, light);

    // Gather the rays of each medium as the solution has them.
    const auto gather = [&](const Medium& medium, int level, bool upward) {
        Eigen::MatrixXd all = Eigen::MatrixXd::Zero(4 * medium.size(), 2);
        for (int i = 0; i < medium.size(); ++i)
            if (medium.roles[i] == Role::view) {
                const RayLevels& levels = lit[medium.rays[i]];
                all.middleRows<4>(4 * i) = upward ? levels.up[level] : levels.down[level];
            }
        return all;
    };
    for (std::size_t d = 0; d < levels_.of_depth.size(); ++d) {
        const int p = levels_.of_depth[d];
        PATINA_EXPECT(p <= count);
        const Medium& medium = media_.layers[levels_.layer_at(p)];
        const Medium& leaving = p == 0 ? above : medium;
        pick(leaving, gather(leaving, p, true), {0, 4}, true, result.upward[d]);
        pick(medium, gather(medium, p, false), {0, 4}, false, result.downward[d]);
    }
}

ModeField FieldSolver::solve(int m) const {
    ModeField result;
    result.upward.resize(levels_.of_depth.size());
    result.downward.resize(levels_.of_depth.size());
    for (auto* side : {&result.upward, &result.downward})
        for (auto& level : *side) level.assign(request_.mu_o.size(), Eigen::Matrix<double, 4, 2>::Zero());
    if (m <= media_.order)
        for (const Components components : component_groups(m, scalar_)) solve_group(m, components, result);
    if (single_.order() > 0 && m <= single_.order()) add_single(m, result);
    for (const auto* side : {&result.upward, &result.downward})
        for (const auto& level : *side)
            for (const auto& amplitudes : level) result.size = std::max(result.size, amplitudes.cwiseAbs().maxCoeff());
    return result;
}

// Adds (2 - delta_m0) of the order's amplitudes with their cosines and sines.
void accumulate(int m, const std::vector<std::vector<Eigen::Matrix<double, 4, 2>>>& amplitudes,
                const std::vector<double>& phi, std::vector<std::vector<std::vector<optics::Stokes>>>& radiance) {
    const double factor = m == 0 ? 1.0 : 2.0;
    for (std::size_t d = 0; d < amplitudes.size(); ++d)
        for (std::size_t o = 0; o < amplitudes[d].size(); ++o)
            for (std::size_t p = 0; p < phi.size(); ++p) {
                const double cosine = factor * std::cos(m * phi[p]), sine = factor * std::sin(m * phi[p]);
                const auto& a = amplitudes[d][o];
                optics::Stokes& s = radiance[d][o][p];
                s.head<2>() += cosine * a.block<2, 1>(0, 0) - sine * a.block<2, 1>(0, 1);
                s.tail<2>() += sine * a.block<2, 1>(2, 0) + cosine * a.block<2, 1>(2, 1);
            }
}

std::vector<Ray> rays_of(const Problem& problem, const FieldRequest& request, int streams) {
    std::vector<Ray> rays = quadrature_rays(problem, streams);
    std::vector<double> indices{problem.refractive_index_above};
    for (const Layer& layer : problem.layers) indices.push_back(layer.refractive_index);
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
    for (double n : indices)
        for (double mu : request.mu_o) rays.push_back({std::max(mu, smallest_cosine), n, 1.0, Role::view});
    rays.push_back({std::max(request.mu_i, smallest_cosine), problem.refractive_index_above, 1.0, Role::beam});
    return rays;
}

}  // namespace

Field solve_field(const Problem& problem, const FieldRequest& request, const SolveOptions& options,
                  const LayerMethod& method) {
    validate(problem);
    validate_request(problem, request);
    const Truncation truncation = truncate(problem, options.streams);
    const StackMedia media(truncation.scaled, rays_of(problem, request, options.streams), options.streams, 0,
                           options.cancel);
    std::vector<double> depths;
    for (double depth : request.optical_depths) depths.push_back(truncation.scaled_depth(problem, depth));
    const Levels levels = cut(media.problem, depths);
    const SingleScattering single(media, truncation, levels.slabs, options.scalar);
    const FieldSolver solver(media, request, levels, method, single, options);

    Field result;
    const optics::Stokes dark = optics::Stokes::Zero();
    result.upward.assign(request.optical_depths.size(),
                         {request.mu_o.size(), std::vector<optics::Stokes>(request.phi.size(), dark)});
    result.downward = result.upward;
    result.diagnostics.streams = options.streams;
    report_quadrature(media, result.diagnostics);
    report_truncation(truncation, result.diagnostics);

    double largest = 0.0;
    int negligible = 0;
    const int orders = std::max(media.order, single.order()) + 1;
    for (int begin = 0; begin < orders && negligible < 2;) {
        const int end = std::min(orders, begin + std::max(1, thread_count()));
        std::vector<ModeField> modes(end - begin);
        parallel_for(begin, end, [&](std::ptrdiff_t m) {
            stop_if_requested(options.cancel);
            modes[m - begin] = solver.solve(static_cast<int>(m));
        });
        for (const ModeField& mode : modes) {
            if (negligible == 2) break;
            accumulate(begin, mode.upward, request.phi, result.upward);
            accumulate(begin, mode.downward, request.phi, result.downward);
            largest = std::max(largest, mode.size);
            negligible = mode.size <= options.fourier_tolerance * largest ? negligible + 1 : 0;
            result.diagnostics.fourier_orders = ++begin;
        }
        if (options.progress) options.progress(static_cast<double>(begin) / orders);
    }
    return result;
}

}  // namespace patina::rt
