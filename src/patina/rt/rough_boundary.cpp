#include "patina/rt/rough_boundary.h"

#include <cmath>

#include "patina/core/constants.h"
#include "patina/core/parallel.h"
#include "patina/rt/balance.h"

namespace patina::rt {

namespace {

using optics::Mueller;

// A ray at the surface.
struct Side {
    double cos_in, cos_out;  // of the propagation direction towards and away from the surface
    double scale, index;
    Role role;
};

std::vector<Side> sides_of(const Medium& upper) {
    std::vector<Side> sides;
    for (int i = 0; i < upper.size(); ++i)
        sides.push_back({-upper.mu[i], upper.mu[i], upper.scale[i], upper.index, upper.roles[i]});
    return sides;
}

}  // namespace

RoughBoundary::RoughBoundary(const RoughSurface& surface, const Medium& upper, std::complex<double> metal, int streams,
                             const CancelToken* cancel)
    : upper_(&upper) {
    const std::vector<Side> sides = sides_of(upper);
    const Eigen::Index rays = static_cast<Eigen::Index>(sides.size());
    const Microfacets facets(surface, upper.index, metal);
    // Lobes are about alpha wide in azimuth at middling angles; the trapezoidal rule on half a turn carries half its
    // points.
    order_ = std::max(8, std::min(static_cast<int>(std::ceil(8.0 / surface.alpha)), 2 * streams));
    const int points = std::max(128, 4 * order_);
    modes_.assign(order_ + 1, Eigen::MatrixXd::Zero(4 * rays, 4 * rays));
    Eigen::MatrixXd mirrors = Eigen::MatrixXd::Zero(rays, rays), cosines(points + 1, order_ + 1),
                    sines(points + 1, order_ + 1);
    for (int p = 0; p <= points; ++p)
        for (int m = 0; m <= order_; ++m) {
            // (1/2pi) int over a turn of an even or odd function.
            const double weight = (p == 0 || p == points ? 0.5 : 1.0) / points;
            cosines(p, m) = weight * std::cos(pi * m * p / points);
            sines(p, m) = weight * std::sin(pi * m * p / points);
        }

    parallel_for(0, rays, [&](std::ptrdiff_t i) {
        stop_if_requested(cancel);
        Eigen::MatrixXd values(16, points + 1);
        for (Eigen::Index o = 0; o < rays; ++o) {
            if (sides[o].role == Role::beam || sides[i].role == Role::view) {
                // Only needed to balance: intensity at order 0.
                if (sides[o].role != Role::quadrature && sides[i].role != Role::quadrature) continue;
            }
            double mean = 0.0;
            for (int p = 0; p <= points; ++p) {
                const double phi = pi * p / points;
                const Mueller f = facets(sides[i].cos_in, sides[o].cos_out, phi);
                values.col(p) = Eigen::Map<const Eigen::Matrix<double, 16, 1>>(f.data());
                mean += cosines(p, 0) * facets(sides[i].cos_in, sides[o].cos_out, phi, true)(0, 0);
            }
            const double factor = 2.0 * pi * sides[o].scale * sides[i].scale;
            const Eigen::MatrixXd even = factor * values * cosines, odd = factor * values * sines;
            mirrors(o, i) = factor * mean;
            for (int m = 0; m <= order_; ++m) {
                Mueller f;
                for (int row = 0; row < 4; ++row)
                    for (int column = 0; column < 4; ++column) {
                        const int place = 4 * column + row;
                        const bool mixes = (row < 2) != (column < 2);
                        f(row, column) = !mixes ? even(place, m) : row < 2 ? -odd(place, m) : odd(place, m);
                    }
                f.bottomRows<2>() *= -1.0;  // Delta on the light that goes up
                modes_[m].block<4, 4>(4 * o, 4 * i) = f;
            }
        }
    });

    // Give back what is lost, and cut what view rays would emit and beam rays receive.
    Eigen::VectorXd flux(rays);
    for (Eigen::Index i = 0; i < rays; ++i) flux[i] = sides[i].scale * sides[i].index;
    const Eigen::MatrixXd balanced = flux.asDiagonal() * mirrors * flux.asDiagonal();
    const Eigen::VectorXd c = balance(balanced, flux.cwiseAbs2(), upper.roles);
    correction_ = largest_correction(c, upper);
    for (Eigen::MatrixXd& mode : modes_)
        for (Eigen::Index i = 0; i < rays; ++i) {
            mode.middleRows<4>(4 * i) *= sides[i].role == Role::beam ? 0.0 : c[i];
            mode.middleCols<4>(4 * i) *= sides[i].role == Role::view ? 0.0 : c[i];
        }
}

Eigen::MatrixXd RoughBoundary::scattering(int m, Components components) const {
    const int c = components.count, rays = upper_->size();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rays * c, rays * c);
    if (m > order_) return result;
    for (int j = 0; j < rays; ++j)
        for (int i = 0; i < rays; ++i)
            result.block(i * c, j * c, c, c) =
                modes_[m].block(4 * i + components.first, 4 * j + components.first, c, c);
    return result;
}

}  // namespace patina::rt
