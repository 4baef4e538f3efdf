#include "patina/rt/boundary.h"

#include <cmath>
#include <map>

#include "patina/optics/fresnel.h"

namespace patina::rt {

namespace {

// Delta M for light turned upward, M Delta for light turned downward; the same matrix because M has no element between
// {I,Q} and {U,V}.
optics::Mueller turned(const optics::Mueller& reflection) {
    return Eigen::Vector4d(1, 1, -1, -1).asDiagonal() * reflection;
}

}  // namespace

Eigen::MatrixXd RayMatrix::times(const Eigen::MatrixXd& dense, Components components) const {
    const int c = components.count, first = components.first;
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows_ * c, dense.cols());
    for (const Entry& entry : entries_)
        result.middleRows(entry.row * c, c).noalias() +=
            entry.mueller.block(first, first, c, c).lazyProduct(dense.middleRows(entry.column * c, c));
    return result;
}

Eigen::MatrixXd RayMatrix::dense(Components components) const {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows_ * components.count, columns_ * components.count);
    add_to(result, components);
    return result;
}

void RayMatrix::add_to(Eigen::MatrixXd& dense, Components components) const {
    const int c = components.count, first = components.first;
    for (const Entry& entry : entries_)
        dense.block(entry.row * c, entry.column * c, c, c) += entry.mueller.block(first, first, c, c);
}

namespace {

// Light totally reflected on both sides of a clear layer never leaves and never got in: 0/0. Taking 1e-14 from each
// total reflection settles it, and is lost in rounding elsewhere.
constexpr double total_reflection = 1.0 - 1e-14;

}  // namespace

Interface interface_between(const Medium& upper, const Medium& lower) {
    Interface result{{upper.size(), upper.size()},
                     {lower.size(), lower.size()},
                     {lower.size(), upper.size()},
                     {upper.size(), lower.size()}};
    std::map<int, int> in_lower, in_upper;
    for (int i = 0; i < lower.size(); ++i) in_lower[lower.rays[i]] = i;
    for (int i = 0; i < upper.size(); ++i) in_upper[upper.rays[i]] = i;

    for (int i = 0; i < upper.size(); ++i) {
        const auto found = in_lower.find(upper.rays[i]);
        const double kept = found == in_lower.end() ? total_reflection : 1.0;
        result.reflection_above.add(i, i,
                                    kept * turned(optics::fresnel_reflection(upper.mu[i], upper.index, lower.index)));
        if (found == in_lower.end()) continue;
        const int j = found->second;
        result.transmission_down.add(j, i, optics::fresnel_transmission(upper.mu[i], upper.index, lower.index));
        result.transmission_up.add(i, j, optics::fresnel_transmission(lower.mu[j], lower.index, upper.index));
    }
    for (int j = 0; j < lower.size(); ++j) {
        const double kept = in_upper.contains(lower.rays[j]) ? 1.0 : total_reflection;
        result.reflection_below.add(j, j,
                                    kept * turned(optics::fresnel_reflection(lower.mu[j], lower.index, upper.index)));
    }
    return result;
}

std::optional<RayMatrix> mirror(const Base& base, const Medium& medium) {
    const auto* metal = std::get_if<MetalBase>(&base);
    if (!metal) return std::nullopt;
    RayMatrix result(medium.size(), medium.size());
    for (int i = 0; i < medium.size(); ++i)
        result.add(i, i, turned(optics::fresnel_reflection(medium.mu[i], medium.index, metal->refractive_index)));
    return result;
}

void add_lambertian(const Base& base, const Medium& medium, Components components, Eigen::MatrixXd& reflection) {
    const auto* lambertian = std::get_if<LambertianBase>(&base);
    if (!lambertian || components.first != 0) return;
    const int c = components.count;
    for (int j = 0; j < medium.size(); ++j) {
        if (medium.roles[j] == Role::view) continue;
        for (int i = 0; i < medium.size(); ++i)
            if (medium.roles[i] != Role::beam)
                reflection(i * c, j * c) += 2.0 * lambertian->reflectance * medium.scale[i] * medium.scale[j];
    }
}

optics::Mueller coherent_reflection(const Problem& problem, const Ray& ray) {
    using optics::Mueller;
    Mueller below = Mueller::Zero();
    const Layer& last = problem.layers.back();
    if (const auto* metal = std::get_if<MetalBase>(&problem.base))
        if (const double mu = ray.cosine_in(last.refractive_index); mu > 0.0)
            below = optics::fresnel_reflection(mu, last.refractive_index, metal->refractive_index);

    // Add layers and interfaces from the base upwards; a ray that does not exist in a medium is reflected above it.
    for (std::size_t k = problem.layers.size(); k-- > 0;) {
        const Layer& layer = problem.layers[k];
        const double n = layer.refractive_index;
        const double above = k > 0 ? problem.layers[k - 1].refractive_index : problem.refractive_index_above;
        const double mu = ray.cosine_in(n), mu_above = ray.cosine_in(above);
        below = mu > 0.0 ? Mueller(std::exp(-2.0 * layer.optical_thickness / mu) * below) : Mueller::Zero();
        if (above == n || mu_above <= 0.0) continue;
        const Mueller outer = k > 0 ? optics::fresnel_reflection(mu_above, above, n) : Mueller::Zero();
        if (mu <= 0.0) {
            below = outer;
            continue;
        }
        const Mueller inner = optics::fresnel_reflection(mu, n, above);
        const Mueller many = (Mueller::Identity() - inner * below).inverse();
        below = outer + optics::fresnel_transmission(mu, n, above) * below * many *
                            optics::fresnel_transmission(mu_above, above, n);
    }
    return below;
}

}  // namespace patina::rt
