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

RayInterface interface_of_ray(const Ray& ray, double upper, double lower) {
    const double mu_upper = ray.cosine_in(upper), mu_lower = ray.cosine_in(lower);
    RayInterface result;
    if (upper == lower) {
        result.transmission_down = result.transmission_up = optics::Mueller::Identity();
        return result;
    }
    const double kept = mu_upper > 0.0 && mu_lower > 0.0 ? 1.0 : total_reflection;
    if (mu_upper > 0.0) result.reflection_above = kept * turned(optics::fresnel_reflection(mu_upper, upper, lower));
    if (mu_lower > 0.0) result.reflection_below = kept * turned(optics::fresnel_reflection(mu_lower, lower, upper));
    if (mu_upper > 0.0 && mu_lower > 0.0) {
        result.transmission_down = optics::fresnel_transmission(mu_upper, upper, lower);
        result.transmission_up = optics::fresnel_transmission(mu_lower, lower, upper);
    }
    return result;
}

Interface interface_between(const std::vector<Ray>& rays, const Medium& upper, const Medium& lower) {
    Interface result{{upper.size(), upper.size()},
                     {lower.size(), lower.size()},
                     {lower.size(), upper.size()},
                     {upper.size(), lower.size()}};
    std::map<int, int> in_lower;
    for (int j = 0; j < lower.size(); ++j) {
        in_lower[lower.rays[j]] = j;
        result.reflection_below.add(j, j,
                                    interface_of_ray(rays[lower.rays[j]], upper.index, lower.index).reflection_below);
    }
    for (int i = 0; i < upper.size(); ++i) {
        const RayInterface of_ray = interface_of_ray(rays[upper.rays[i]], upper.index, lower.index);
        result.reflection_above.add(i, i, of_ray.reflection_above);
        const auto found = in_lower.find(upper.rays[i]);
        if (found == in_lower.end()) continue;
        result.transmission_down.add(found->second, i, of_ray.transmission_down);
        result.transmission_up.add(i, found->second, of_ray.transmission_up);
    }
    return result;
}

optics::Mueller mirror_reflection(const Base& base, double mu, double index) {
    if (const auto* metal = std::get_if<MetalBase>(&base); metal && !metal->roughness)
        return optics::fresnel_reflection(mu, index, metal->refractive_index);
    if (const auto* known = std::get_if<SurfaceBase>(&base)) return known->surface->specular(mu);
    return optics::Mueller::Zero();
}

std::optional<RayMatrix> mirror(const Base& base, const Medium& medium) {
    const auto* metal = std::get_if<MetalBase>(&base);
    if (!(metal && !metal->roughness) && !std::holds_alternative<SurfaceBase>(base)) return std::nullopt;
    RayMatrix result(medium.size(), medium.size());
    for (int i = 0; i < medium.size(); ++i)
        result.add(i, i, turned(mirror_reflection(base, medium.mu[i], medium.index)));
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
    if (const double mu = ray.cosine_in(last.refractive_index); mu > 0.0)
        below = mirror_reflection(problem.base, mu, last.refractive_index);

    // Add layers and interfaces from the base upwards; a ray that does not exist in a medium is reflected above it.
    for (std::size_t k = problem.layers.size(); k-- > 0;) {
        const Layer& layer = problem.layers[k];
        const double n = layer.refractive_index;
        const double above = k > 0 ? problem.layers[k - 1].refractive_index : problem.refractive_index_above;
        const double mu = ray.cosine_in(n), mu_above = ray.cosine_in(above);
        // A rough top leaves no ray unscattered.
        if (k == 0 && problem.has_rough_top()) return Mueller::Zero();
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
