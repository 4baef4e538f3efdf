#include "patina/rt/single_scattering.h"

#include <algorithm>
#include <cmath>

#include "patina/math/path_integrals.h"
#include "patina/rt/boundary.h"

namespace patina::rt {

namespace {

using optics::Mueller;
using Amplitudes = Eigen::Matrix<double, 4, 2>;

// diag(1,1,1,-1) M^T diag(1,1,1,-1): the same light path the other way round.
Mueller reversed(const Mueller& path) {
    Mueller result = path.transpose();
    result.row(3) *= -1.0;
    result.col(3) *= -1.0;
    return result;
}

}  // namespace

RayPath::RayPath(const Problem& problem, const std::vector<Slab>& slabs, const Ray& ray, bool scalar) {
    const std::size_t count = slabs.size();
    const auto mask = [&](Mueller matrix) {
        const double intensity = matrix(0, 0);
        if (scalar) matrix.setZero();
        if (scalar) matrix(0, 0) = intensity;
        return matrix;
    };
    tops_.resize(count);
    attenuation_.resize(count);
    below_.resize(count);
    bottom_.resize(count);

    // Add slabs and interfaces from the base upwards.
    Mueller reflection = Mueller::Zero();
    const double lowest = problem.layers.back().refractive_index;
    if (const double mu = ray.cosine_in(lowest); mu > 0.0)
        reflection = Eigen::Vector4d(1, 1, -1, -1).asDiagonal() * mask(mirror_reflection(problem.base, mu, lowest));
    for (std::size_t p = count; p-- > 0;) {
        const int k = slabs[p].layer;
        const double n = problem.layers[k].refractive_index, mu = ray.cosine_in(n);
        attenuation_[p] = mu > 0.0 ? std::exp(-slabs[p].optical_thickness / mu) : 0.0;
        bottom_[p] = reflection;
        below_[p] = attenuation_[p] * attenuation_[p] * reflection;
        const bool starts_layer = p == 0 || slabs[p - 1].layer != k;
        const double above = !starts_layer ? n
                             : k > 0       ? problem.layers[k - 1].refractive_index
                                           : problem.refractive_index_above;
        // Through a rough top no light stays unscattered.
        const RayInterface interface =
            p == 0 && problem.has_rough_top() ? RayInterface{} : interface_of_ray(ray, above, n);
        tops_[p] = {mask(interface.reflection_below), mask(interface.transmission_down),
                    mask(interface.transmission_up)};
        reflection = mask(interface.reflection_above) + tops_[p].transmission_up * below_[p] * downward(p);
    }
}

// Light going down under the interface of a slab, per unit of light coming down onto it.
Mueller RayPath::downward(std::size_t p) const {
    return (Mueller::Identity() - tops_[p].reflection_below * below_[p]).inverse() * tops_[p].transmission_down;
}

RayLight RayPath::unscattered() const {
    RayLight light;
    Mueller down = Mueller::Identity();
    for (std::size_t p = 0; p < tops_.size(); ++p) {
        down = downward(p) * down;
        light.down.push_back(down);
        down *= attenuation_[p];
        light.up.push_back(bottom_[p] * down);
    }
    return light;
}

RayLevels RayPath::lit_by(const RayLevels& emission) const {
    const std::size_t count = tops_.size();
    // What comes up at the top and at the bottom of each slab when nothing comes down on it.
    std::vector<Amplitudes> rising_top(count), rising_bottom(count);
    Amplitudes rising = Amplitudes::Zero();
    for (std::size_t p = count; p-- > 0;) {
        rising_bottom[p] = rising;
        rising_top[p] = emission.up[p] + attenuation_[p] * (bottom_[p] * emission.down[p] + rising);
        const Mueller many = (Mueller::Identity() - below_[p] * tops_[p].reflection_below).inverse();
        rising = tops_[p].transmission_up * many * rising_top[p];
    }

    RayLevels levels{std::vector<Amplitudes>(count + 1, Amplitudes::Zero()), std::vector<Amplitudes>(count + 1)};
    levels.up[0] = rising;
    Amplitudes down = Amplitudes::Zero();
    for (std::size_t p = 0; p < count; ++p) {
        const Mueller many = (Mueller::Identity() - tops_[p].reflection_below * below_[p]).inverse();
        down = many * (tops_[p].transmission_down * down + tops_[p].reflection_below * rising_top[p]);
        if (p == 0) levels.down[0] = down;
        down = attenuation_[p] * down + emission.down[p];
        levels.down[p + 1] = down;
        levels.up[p + 1] = rising_bottom[p] + bottom_[p] * down;
    }
    return levels;
}

SingleScattering::SingleScattering(const StackMedia& media, const Truncation& truncation, std::vector<Slab> slabs,
                                   bool scalar)
    : media_(media), truncation_(truncation), slabs_(std::move(slabs)), scalar_(scalar) {
    if (order() == 0) return;
    for (const Ray& ray : media_.rays) {
        paths_.emplace_back(media_.problem, slabs_, ray, scalar);
        lights_.push_back(paths_.back().unscattered());
    }
}

void SingleScattering::add_reflection(int m, Eigen::MatrixXd& reflection) const {
    for (std::size_t p = 0; p < slabs_.size(); ++p) {
        const int k = slabs_[p].layer;
        const auto& lacking = truncation_.lacking[k];
        if (m > lacking.order() || slabs_[p].optical_thickness == 0.0) continue;

        // Of the slab's rays those that reach the medium above, by their position there.
        Medium seen{
            media_.layers[k].index, {}, Eigen::VectorXd(media_.above.size()), Eigen::VectorXd(media_.above.size()), {}};
        std::vector<int> place;
        for (int a = 0; a < media_.above.size(); ++a) {
            const Ray& ray = media_.rays[media_.above.rays[a]];
            const double mu = ray.cosine_in(seen.index);
            if (mu <= 0.0) continue;
            seen.mu[place.size()] = mu;
            seen.scale[place.size()] = std::sqrt(ray.flux_weight) / seen.index;
            seen.rays.push_back(media_.above.rays[a]);
            place.push_back(a);
        }
        const Eigen::Index count = static_cast<Eigen::Index>(place.size());
        seen.mu.conservativeResize(count);
        seen.scale.conservativeResize(count);

        const PhaseSums sums = phase_sums(lacking, seen, m);
        for (Eigen::Index j = 0; j < count; ++j) {
            const Mueller &down = lights_[seen.rays[j]].down[p], &up = lights_[seen.rays[j]].up[p];
            for (Eigen::Index i = 0; i < count; ++i) {
                const double a = 1.0 / seen.mu[i], b = 1.0 / seen.mu[j];
                const double same = math::path_through(a, b, slabs_[p].optical_thickness),
                             turned = math::path_back(a, b, slabs_[p].optical_thickness);
                const Mueller forward = same * sums.same.block<4, 4>(4 * i, 4 * j);
                const Mueller backward = turned * sums.opposite.block<4, 4>(4 * i, 4 * j);
                // By reciprocity light leaves the stack as it would come in.
                const RayLight& out = lights_[seen.rays[i]];
                reflection.block<4, 4>(4 * place[i], 4 * place[j]) +=
                    reversed(out.down[p]) * (backward * down + forward * up) +
                    reversed(out.up[p]) * (forward * down + backward * up);
            }
        }
    }
    if (scalar_)
        for (Eigen::Index i = 0; i < reflection.rows(); ++i)
            for (Eigen::Index j = 0; j < reflection.cols(); ++j)
                if (i % 4 != 0 || j % 4 != 0) reflection(i, j) = 0.0;
}

std::vector<RayLevels> SingleScattering::field(int m, const Eigen::Matrix<double, 4, 2>& incident) const {
    const std::size_t count = slabs_.size(), rays = media_.rays.size();
    std::vector<RayLevels> emission(rays), result(rays);
    for (std::size_t r = 0; r < rays; ++r)
        if (media_.rays[r].role == Role::view) emission[r].up.assign(count, Amplitudes::Zero());
    for (std::size_t r = 0; r < rays; ++r) emission[r].down = emission[r].up;

    for (std::size_t p = 0; p < count; ++p) {
        const Medium& medium = media_.layers[slabs_[p].layer];
        const auto& lacking = truncation_.lacking[slabs_[p].layer];
        if (m > lacking.order() || slabs_[p].optical_thickness == 0.0) continue;
        const PhaseSums sums = phase_sums(lacking, medium, m);
        for (int j = 0; j < medium.size(); ++j) {
            if (medium.roles[j] != Role::beam) continue;
            const RayLight& light = lights_[medium.rays[j]];
            const Amplitudes down = light.down[p] * incident, up = light.up[p] * incident;
            for (int i = 0; i < medium.size(); ++i) {
                if (medium.roles[i] != Role::view) continue;
                const double a = 1.0 / medium.mu[i], b = 1.0 / medium.mu[j], thickness = slabs_[p].optical_thickness;
                const Mueller forward = math::path_through(a, b, thickness) * sums.same.block<4, 4>(4 * i, 4 * j);
                const Mueller backward = math::path_back(a, b, thickness) * sums.opposite.block<4, 4>(4 * i, 4 * j);
                emission[medium.rays[i]].down[p] += forward * down + backward * up;
                emission[medium.rays[i]].up[p] += backward * down + forward * up;
            }
        }
    }
    for (std::size_t r = 0; r < rays; ++r)
        if (media_.rays[r].role == Role::view) result[r] = paths_[r].lit_by(emission[r]);
    return result;
}

}  // namespace patina::rt
