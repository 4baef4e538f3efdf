#include "patina/rt/rough_interface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "patina/core/constants.h"
#include "patina/core/parallel.h"
#include "patina/math/quadrature.h"
#include "patina/rt/balance.h"

namespace patina::rt {

namespace {

using optics::Mueller;

// Azimuths from 0 to pi, dense around 0 where lobes are, with the weights of (1/2pi) int over a turn of an even or odd
// function times cos(m phi) and sin(m phi).
struct Azimuths {
    std::vector<double> phi;
    Eigen::MatrixXd cosines, sines;  // [point][m]

    explicit Azimuths(int order) {
        // phi = pi t^2 turns cos(m phi) at most 2 m pi per unit of t.
        const math::Quadrature rule = math::gauss_legendre(std::max(64, 2 * order + 24), 0.0, 1.0);
        cosines.resize(rule.size(), order + 1);
        sines.resize(rule.size(), order + 1);
        for (int p = 0; p < rule.size(); ++p) {
            phi.push_back(pi * rule.nodes[p] * rule.nodes[p]);
            const double weight = 2.0 * rule.nodes[p] * rule.weights[p];
            for (int m = 0; m <= order; ++m) {
                cosines(p, m) = weight * std::cos(m * phi[p]);
                sines(p, m) = weight * std::sin(m * phi[p]);
            }
        }
    }
};

// Directions that stand for a ray: itself, or points of its cell of flux, by nu^2 = (n sin(theta))^2.
struct Cell {
    std::vector<double> squares, weights;  // weights add up to 1
    int rank = -1;                         // among the quadrature rays by nu
};

double square_of(const Ray& ray) {
    return ray.index * ray.index * (1.0 - ray.cosine) * (1.0 + ray.cosine);
}

double cosine_at(double square, double index) {
    return std::sqrt(std::max(0.0, 1.0 - square / (index * index)));
}

// The quadrature rays' flux weights n^2 mu w = d(nu^2)/2 divide the range of nu^2.
std::vector<Cell> cells_of(const std::vector<Ray>& rays, int points) {
    std::vector<int> by_square(rays.size());
    std::iota(by_square.begin(), by_square.end(), 0);
    std::sort(by_square.begin(), by_square.end(),
              [&](int a, int b) { return square_of(rays[a]) < square_of(rays[b]); });
    std::vector<Cell> cells(rays.size());
    double begin = 0.0;
    int rank = 0;
    for (const int r : by_square) {
        if (rays[r].role != Role::quadrature) {
            cells[r] = {{square_of(rays[r])}, {1.0}, -1};
            continue;
        }
        const double end = begin + 2.0 * rays[r].flux_weight;
        const math::Quadrature rule = math::gauss_legendre(points, begin, end);
        cells[r].squares = rule.nodes;
        for (const double weight : rule.weights) cells[r].weights.push_back(weight / (end - begin));
        cells[r].rank = rank++;
        begin = end;
    }
    return cells;
}

// Lobes of grazing rays are narrower in azimuth than the orders carry. A Gaussian as wide as it takes to bring their
// last order to `negligible` smooths them: a mean over azimuths keeps flux, positivity and realizability.
void smooth(std::vector<Mueller>& modes) {
    constexpr double negligible = 1e-3;
    const int last = static_cast<int>(modes.size()) - 1;
    if (last == 0) return;
    const double tail = std::max(std::abs(modes[last](0, 0)), std::abs(modes[last - 1](0, 0)));
    if (!(tail > negligible * modes[0](0, 0))) return;
    const double width = std::sqrt(2.0 * std::log(tail / (negligible * modes[0](0, 0)))) / last;
    for (int m = 1; m <= last; ++m) modes[m] *= std::exp(-0.5 * std::pow(m * width, 2));
}

// Fourier modes of the facets' matrix between directions, averaged over their cells: [m], the blocks of Reflection.
std::vector<Mueller> modes_between(const Microfacets& facets, const Azimuths& azimuths, const Cell& out, double sign_o,
                                   double index_o, const Cell& in, double sign_i, double index_i) {
    const Eigen::Index points = azimuths.cosines.rows();
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(16, points);
    for (std::size_t a = 0; a < out.squares.size(); ++a)
        for (std::size_t b = 0; b < in.squares.size(); ++b) {
            const double cos_o = cosine_at(out.squares[a], index_o), cos_i = cosine_at(in.squares[b], index_i);
            if (cos_o == 0.0 || cos_i == 0.0) continue;
            for (Eigen::Index p = 0; p < points; ++p) {
                const Mueller f = facets(sign_i * cos_i, sign_o * cos_o, azimuths.phi[p]);
                values.col(p) +=
                    out.weights[a] * in.weights[b] * Eigen::Map<const Eigen::Matrix<double, 16, 1>>(f.data());
            }
        }
    const Eigen::MatrixXd even = values * azimuths.cosines, odd = values * azimuths.sines;
    std::vector<Mueller> modes(static_cast<std::size_t>(azimuths.cosines.cols()));
    for (std::size_t m = 0; m < modes.size(); ++m)
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column) {
                const Eigen::Index place = 4 * column + row, order = static_cast<Eigen::Index>(m);
                const bool mixes = (row < 2) != (column < 2);
                modes[m](row, column) = !mixes ? even(place, order) : row < 2 ? -odd(place, order) : odd(place, order);
            }
    smooth(modes);
    return modes;
}

Mueller reversed(const Mueller& path) {
    return optics::reversal() * path.transpose() * optics::reversal();
}

// Only what goes from quadrature or beam rays to quadrature or view rays counts; the rest serves the balance.
bool counts(Role out, Role in) {
    return out == Role::quadrature || in == Role::quadrature || out != in;
}

// Reflection modes on one side, in the solver's variables.
std::vector<Eigen::MatrixXd> reflection_modes(const Microfacets& facets, const Azimuths& azimuths, const Medium& medium,
                                              double sign_i, const CancelToken* cancel) {
    const int rays = medium.size();
    std::vector<Eigen::MatrixXd> modes(static_cast<std::size_t>(azimuths.cosines.cols()),
                                       Eigen::MatrixXd::Zero(4 * rays, 4 * rays));
    const auto at = [&](int i) {
        return Cell{{medium.index * medium.index * (1.0 - medium.mu[i]) * (1.0 + medium.mu[i])}, {1.0}, -1};
    };
    parallel_for(0, rays, [&](std::ptrdiff_t i) {
        stop_if_requested(cancel);
        for (int o = static_cast<int>(i); o < rays; ++o) {
            if (!counts(medium.roles[o], medium.roles[i])) continue;
            const double factor = 2.0 * pi * medium.scale[o] * medium.scale[i];
            const auto pair = modes_between(facets, azimuths, at(o), -sign_i, medium.index, at(static_cast<int>(i)),
                                            sign_i, medium.index);
            for (std::size_t m = 0; m < modes.size(); ++m) {
                modes[m].block<4, 4>(4 * o, 4 * i) = factor * pair[m];
                modes[m].block<4, 4>(4 * i, 4 * o) = factor * reversed(pair[m]);
            }
        }
    });
    return modes;
}

// Flux of intensity from ray to ray at m = 0.
Eigen::MatrixXd intensity_flux(const Eigen::MatrixXd& mode, const Eigen::VectorXd& v_o, const Eigen::VectorXd& v_i) {
    Eigen::MatrixXd flux(v_o.size(), v_i.size());
    for (Eigen::Index i = 0; i < v_i.size(); ++i)
        for (Eigen::Index o = 0; o < v_o.size(); ++o) flux(o, i) = v_o[o] * mode(4 * o, 4 * i) * v_i[i];
    return flux;
}

Eigen::VectorXd is_quadrature(const Medium& medium) {
    Eigen::VectorXd result(medium.size());
    for (int i = 0; i < medium.size(); ++i) result[i] = medium.roles[i] == Role::quadrature ? 1.0 : 0.0;
    return result;
}

// Flux of intensity that rays of the given weights receive from each ray's I and Q.
Eigen::MatrixX2d sent(const Eigen::MatrixXd& mode, const Eigen::VectorXd& weights) {
    Eigen::MatrixX2d result = Eigen::MatrixX2d::Zero(mode.cols() / 4, 2);
    for (Eigen::Index i = 0; i < result.rows(); ++i)
        for (Eigen::Index o = 0; o < weights.size(); ++o) result.row(i) += weights[o] * mode.block<1, 2>(4 * o, 4 * i);
    return result;
}

// Reflectance by one facet, mean over each ray's cell.
Eigen::VectorXd mean_albedo(const Microfacets& facets, const std::vector<Cell>& cells, const Medium& medium,
                            bool from_above) {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(medium.size());
    for (int i = 0; i < medium.size(); ++i) {
        const Cell& cell = cells[medium.rays[i]];
        for (std::size_t k = 0; k < cell.squares.size(); ++k) {
            const double cosine = cosine_at(cell.squares[k], medium.index);
            if (cosine > 0.0) result[i] += cell.weights[k] * facets.reflectance(from_above ? -cosine : cosine);
        }
    }
    return result;
}

}  // namespace

RoughInterface::RoughInterface(const RoughSurface& surface, const std::vector<Ray>& rays, const Medium& upper,
                               const Medium& lower, int streams, int most_orders, const CancelToken* cancel)
    : upper_(upper), lower_(lower) {
    const Microfacets facets(surface, upper.index, lower.index);
    // A facet tilted by d turns reflected light by 2 d, but refracted light in the denser medium only by (1 - 1/n) d:
    // those lobes are the narrowest in azimuth. Beckmann's fall off like a Gaussian, GGX's like an exponential.
    const double ratio = std::max(upper.index, lower.index) / std::min(upper.index, lower.index);
    const double narrowest = surface.alpha * std::max(0.2, 1.0 - 1.0 / ratio);
    const double reach = surface.distribution == FacetDistribution::ggx ? 16.0 : 8.0;
    order_ = std::max(8, std::min(static_cast<int>(std::ceil(reach / narrowest)), 4 * streams));
    if (most_orders == 1) order_ = 0;
    const Azimuths azimuths(order_);

    // A facet tilted by d turns refracted light in the thinner medium by about (n - 1) d: points for a cell to see
    // lobes that are narrower than itself.
    const double width = 0.5 * surface.alpha * (ratio - 1.0), spacing = 0.5 * pi / streams;
    const int points = std::clamp(static_cast<int>(std::ceil(1.2 * spacing / width)), 2, 12);
    const std::vector<Cell> fine = cells_of(rays, points), coarse = cells_of(rays, 2);

    above_ = reflection_modes(facets, azimuths, upper, -1.0, cancel);
    below_ = reflection_modes(facets, azimuths, lower, 1.0, cancel);
    down_.assign(static_cast<std::size_t>(order_) + 1, Eigen::MatrixXd::Zero(4 * lower.size(), 4 * upper.size()));
    parallel_for(0, upper.size(), [&](std::ptrdiff_t i) {
        stop_if_requested(cancel);
        for (int o = 0; o < lower.size(); ++o) {
            if (!counts(lower.roles[o], upper.roles[i])) continue;
            const int in = upper.rays[i], out = lower.rays[o];
            const bool far = fine[in].rank >= 0 && fine[out].rank >= 0 && std::abs(fine[in].rank - fine[out].rank) > 2;
            const std::vector<Cell>& cells = far ? coarse : fine;
            const auto pair =
                modes_between(facets, azimuths, cells[out], -1.0, lower.index, cells[in], -1.0, upper.index);
            const double factor = 2.0 * pi * lower.scale[o] * upper.scale[i];
            for (int m = 0; m <= order_; ++m) down_[m].block<4, 4>(4 * o, 4 * i) = factor * pair[m];
        }
    });
    close_energy(mean_albedo(facets, fine, upper, true), mean_albedo(facets, fine, lower, false));
}

void RoughInterface::close_energy(const Eigen::VectorXd& upper_albedo, const Eigen::VectorXd& lower_albedo) {
    const Eigen::VectorXd v_upper = upper_.scale * upper_.index, v_lower = lower_.scale * lower_.index;
    const Eigen::VectorXd w_upper = is_quadrature(upper_), w_lower = is_quadrature(lower_);
    const Eigen::MatrixXd down = intensity_flux(down_[0], v_lower, v_upper);
    const Eigen::VectorXd passed_upper = down.transpose() * w_lower, passed_lower = down * w_upper;

    // Make the reflected lobes carry their flux, at most what refraction leaves.
    const auto balance_side = [&](Modes& modes, const Medium& medium, const Eigen::VectorXd& v,
                                  const Eigen::VectorXd& albedo, const Eigen::VectorXd& passed) {
        const Eigen::VectorXd flux = v.cwiseAbs2();
        const Eigen::VectorXd target = albedo.cwiseProduct(flux).cwiseMin((flux - passed).cwiseMax(1e-12 * flux));
        const Eigen::VectorXd c = balance(intensity_flux(modes[0], v, v), target, medium.roles);
        correction_ = std::max(correction_, largest_correction(c, medium));
        // From beam to view rays no sum is asked for, and the facets' own value stands.
        for (Eigen::MatrixXd& mode : modes)
            for (int i = 0; i < medium.size(); ++i)
                for (int o = 0; o < medium.size(); ++o)
                    if (medium.roles[o] == Role::quadrature || medium.roles[i] == Role::quadrature)
                        mode.block<4, 4>(4 * o, 4 * i) *= c[o] * c[i];
    };
    balance_side(above_, upper_, v_upper, upper_albedo, passed_upper);
    balance_side(below_, lower_, v_lower, lower_albedo, passed_lower);

    // Give back what meets several facets, of polarized light what it loses: v e_I - sum over the rays, columns I and
    // Q.
    const auto lost = [](const Eigen::VectorXd& v, const Eigen::MatrixX2d& sent) {
        Eigen::MatrixX2d result = -sent;
        result.col(0) += v;
        return result;
    };
    const Eigen::VectorXd all_upper = v_upper.cwiseProduct(w_upper), all_lower = v_lower.cwiseProduct(w_lower);
    const Eigen::MatrixX2d lost_upper = lost(v_upper, sent(above_[0], all_upper) + sent(down_[0], all_lower));
    const Eigen::MatrixX2d lost_lower =
        lost(v_lower, sent(below_[0], all_lower) + sent(down_[0].transpose(), all_upper));
    const double total = all_upper.dot(lost_upper.col(0)) + all_lower.dot(lost_lower.col(0));
    const auto give_back = [&](Eigen::MatrixXd& mode, const Eigen::MatrixX2d& out, const Eigen::MatrixX2d& in) {
        for (Eigen::Index i = 0; i < in.rows(); ++i)
            for (Eigen::Index o = 0; o < out.rows(); ++o)
                mode.block<2, 2>(4 * o, 4 * i) += out.row(o).transpose() * in.row(i) / total;
    };
    if (total > 0.0) {
        give_back(above_[0], lost_upper, lost_upper);
        give_back(below_[0], lost_lower, lost_lower);
        give_back(down_[0], lost_lower, lost_upper);
    }
}

RoughInterface::Operators RoughInterface::operators(int m, Components components) const {
    const int c = components.count, first = components.first;
    const auto zero = [&](const Medium& out, const Medium& in) {
        return Eigen::MatrixXd(Eigen::MatrixXd::Zero(out.size() * c, in.size() * c));
    };
    Operators result{zero(upper_, upper_), zero(lower_, lower_), zero(lower_, upper_), zero(upper_, lower_)};
    if (m > order_) return result;

    // Upward light is multiplied by Delta; view rays send nothing and beam rays receive nothing.
    const Mueller delta = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
    const auto copy = [&](Eigen::MatrixXd& to, const Medium& out, const Medium& in, const auto& block) {
        for (int i = 0; i < in.size(); ++i)
            for (int o = 0; o < out.size(); ++o)
                if (in.roles[i] != Role::view && out.roles[o] != Role::beam)
                    to.block(o * c, i * c, c, c) = Mueller(block(o, i)).block(first, first, c, c);
    };
    const Eigen::MatrixXd &above = above_[m], &below = below_[m], &down = down_[m];
    copy(result.reflection_above, upper_, upper_,
         [&](int o, int i) { return delta * above.block<4, 4>(4 * o, 4 * i); });
    copy(result.reflection_below, lower_, lower_,
         [&](int o, int i) { return below.block<4, 4>(4 * o, 4 * i) * delta; });
    copy(result.transmission_down, lower_, upper_, [&](int o, int i) { return down.block<4, 4>(4 * o, 4 * i); });
    copy(result.transmission_up, upper_, lower_,
         [&](int o, int i) -> Mueller { return delta * reversed(down.block<4, 4>(4 * i, 4 * o)) * delta; });
    return result;
}

}  // namespace patina::rt
