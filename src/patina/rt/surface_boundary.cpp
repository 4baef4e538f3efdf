#include "patina/rt/surface_boundary.h"

#include "patina/core/constants.h"
#include "patina/rt/balance.h"

namespace patina::rt {

SurfaceBoundary::SurfaceBoundary(const SurfaceReflection& surface, const Medium& upper)
    : surface_(surface), upper_(upper) {
    const Eigen::MatrixXd mean = unbalanced(0);
    const int rays = upper.size();
    Eigen::MatrixXd flux(rays, rays);
    Eigen::VectorXd target(rays);
    for (int i = 0; i < rays; ++i) {
        for (int o = 0; o < rays; ++o) flux(o, i) = upper.scale[o] * mean(4 * o, 4 * i) * upper.scale[i];
        target[i] = surface.albedo(upper.mu[i]) * upper.scale[i] * upper.scale[i];
    }
    factors_ = balance(flux, target, upper.roles);
    correction_ = largest_correction(factors_, upper);
}

Eigen::MatrixXd SurfaceBoundary::unbalanced(int m) const {
    Eigen::MatrixXd result = surface_.mode(m, upper_.mu);
    for (int i = 0; i < upper_.size(); ++i) {
        result.middleRows<4>(4 * i) *= 2.0 * pi * upper_.scale[i];
        result.middleRows<2>(4 * i + 2) *= -1.0;  // Delta on the light that goes up
        result.middleCols<4>(4 * i) *= upper_.scale[i];
    }
    return result;
}

Eigen::MatrixXd SurfaceBoundary::scattering(int m, Components components) const {
    const int c = components.count, rays = upper_.size();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rays * c, rays * c);
    if (m > order()) return result;
    const Eigen::MatrixXd all = unbalanced(m);
    for (int i = 0; i < rays; ++i) {
        if (upper_.roles[i] == Role::view) continue;
        for (int o = 0; o < rays; ++o)
            if (upper_.roles[o] != Role::beam)
                result.block(o * c, i * c, c, c) =
                    factors_[o] * factors_[i] * all.block(4 * o + components.first, 4 * i + components.first, c, c);
    }
    return result;
}

}  // namespace patina::rt
