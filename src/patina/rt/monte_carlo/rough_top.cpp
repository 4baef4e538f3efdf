#include "patina/rt/monte_carlo/rough_top.h"

#include <numbers>

namespace patina::rt::monte_carlo {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int cells = 256;  // of the cosine

// tan^2 of the tilt of a facet, by the share u of facets that are tilted less.
double squared_slope(const RoughSurface& surface, double u) {
    const double unit = surface.distribution == FacetDistribution::ggx ? u / (1.0 - u) : -std::log1p(-u);
    return surface.alpha * surface.alpha * unit;
}

Vector tilted(double squared_slope, double turn) {
    const double cosine = 1.0 / std::sqrt(1.0 + squared_slope), sine = std::sqrt(squared_slope) * cosine;
    return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

}  // namespace

RoughTop::RoughTop(const RoughSurface& surface, double above, double below, bool scalar)
    : surface_(surface), above_(above), below_(below), scalar_(scalar) {
    for (int c = 0; c <= cells; ++c) {
        const double mu = std::max(1e-4, static_cast<double>(c) / cells);
        lost_above_.push_back(integrate_lost(-mu));
        lost_below_.push_back(integrate_lost(mu));
    }
    const auto flux = [](const std::vector<Loss>& table) {
        double sum = 0.0;
        for (int c = 0; c <= cells; ++c)
            sum += (c == cells ? 0.5 : 1.0) * c / (cells * static_cast<double>(cells)) *
                   table[static_cast<std::size_t>(c)].i;
        return sum;
    };
    const double up = above * above * flux(lost_above_), down = below * below * flux(lost_below_);
    lost_total_ = 2.0 * pi * (up + down);
    lost_share_above_ = up / (up + down);
}

InterfaceGains RoughTop::interface(double cos_i, double n1, double n2) const {
    InterfaceGains gains = dielectric_interface(cos_i, n1, n2);
    if (scalar_) {
        gains.reflect = unpolarized(gains.reflect);
        gains.transmit = unpolarized(gains.transmit);
    }
    return gains;
}

// Walter et al. (2007), eqs 25 and 33.
double RoughTop::density(double cos_h) const {
    const double a2 = surface_.alpha * surface_.alpha, c2 = cos_h * cos_h, t2 = (1.0 - c2) / c2;
    if (surface_.distribution == FacetDistribution::beckmann) return std::exp(-t2 / a2) / (pi * a2 * c2 * c2);
    return a2 / (pi * c2 * c2 * (a2 + t2) * (a2 + t2));
}

// Eqs 27 (with the exact error function) and 34.
double RoughTop::unshadowed(double cosine) const {
    const double tangent = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) / std::max(cosine, 1e-300);
    const double x = surface_.alpha * tangent;
    if (x == 0.0) return 1.0;
    if (surface_.distribution == FacetDistribution::ggx) return 2.0 / (1.0 + std::sqrt(1.0 + x * x));
    return 2.0 / (1.0 + std::erf(1.0 / x) + x * std::exp(-1.0 / (x * x)) / std::sqrt(pi));
}

RoughTop::Facet RoughTop::facet_between(const Vector& k_in, const Vector& k_out) const {
    const bool from_above = k_in.z() < 0.0, reflects = (k_out.z() > 0.0) == from_above;
    const double n_i = from_above ? above_ : below_, n_t = from_above ? below_ : above_;
    Vector normal = reflects ? Vector(k_out - k_in) : Vector(n_t * k_out - n_i * k_in);
    const double length = normal.norm();
    if (!(length > 0.0)) return {normal, {}, 0.0};
    normal /= length;
    if ((normal.z() > 0.0) != from_above) normal = -normal;
    const double in = std::min(1.0, -k_in.dot(normal)), out = k_out.dot(normal);
    if (in <= 0.0 || (out > 0.0) != reflects) return {normal, {}, 0.0};

    const InterfaceGains gains = interface(in, n_i, n_t);
    const double seen = density(std::abs(normal.z())) * unshadowed(std::abs(k_in.z())) *
                        unshadowed(std::abs(k_out.z())) / std::abs(k_in.z() * k_out.z());
    if (reflects) return {normal, gains.reflect, 0.25 * seen};
    if (gains.cos_t == 0.0) return {normal, {}, 0.0};
    const double root = n_i * in + n_t * out;
    return {normal, gains.transmit, seen * in * -out * n_t * n_t / (root * root)};
}

Vector RoughTop::draw_normal(RandomStream& random) const {
    const double u = random.uniform();
    return tilted(squared_slope(surface_, u), 2.0 * pi * random.uniform());
}

RoughTop::Loss RoughTop::lost(double k_z) const {
    const std::vector<Loss>& table = k_z < 0.0 ? lost_above_ : lost_below_;
    const double place = std::min(std::abs(k_z), 1.0) * cells;
    const int cell = std::min(static_cast<int>(place), cells - 1);
    const double t = place - cell;
    const Loss &a = table[static_cast<std::size_t>(cell)], &b = table[static_cast<std::size_t>(cell) + 1];
    return {(1.0 - t) * a.i + t * b.i, (1.0 - t) * a.q + t * b.q};
}

Frame RoughTop::draw_lost(RandomStream& random) const {
    const bool up = random.uniform() < lost_share_above_;
    double most = 0.0;
    for (const Loss& loss : up ? lost_above_ : lost_below_) most = std::max(most, loss.i);
    double mu;
    do mu = std::sqrt(random.uniform());
    while (random.uniform() * most > lost(up ? -mu : mu).i);
    const double turn = 2.0 * pi * random.uniform();
    return meridian_frame(up ? mu : -mu, std::cos(turn), std::sin(turn));
}

RoughTop::Loss RoughTop::integrate_lost(double k_z) const {
    constexpr int slopes = 48, turns = 48;
    const double up = std::abs(k_z), across = std::sqrt(std::max(0.0, 1.0 - up * up));
    const double n_i = k_z < 0.0 ? above_ : below_, n_t = k_z < 0.0 ? below_ : above_;
    double all = 0.0, free_i = 0.0, free_q = 0.0;
    for (int a = 0; a < slopes; ++a)
        for (int b = 0; b < turns; ++b) {
            // The cumulative distribution u = sin^2 t of slopes makes the long tail of GGX smooth in t.
            const double t = 0.5 * pi * (a + 0.5) / slopes, share = std::sin(2.0 * t);
            const Vector normal = tilted(squared_slope(surface_, std::pow(std::sin(t), 2)), pi * (b + 0.5) / turns);
            const double cosine = std::min(1.0, across * normal.x() + up * normal.z());
            if (cosine <= 0.0) continue;
            const double weight = share * cosine / normal.z();
            all += weight;

            // The plane of incidence turns from the meridian plane by the angle whose sine is normal.y / sine.
            const double sine2 = (1.0 - cosine) * (1.0 + cosine);
            const double turn = sine2 > 1e-12 ? 1.0 - 2.0 * normal.y() * normal.y() / sine2 : 1.0;
            const InterfaceGains gains = interface(cosine, n_i, n_t);
            const auto add = [&](const Gain& gain, double out) {
                if (out <= 0.0) return;
                free_i += weight * 0.5 * (gain.pp + gain.ss) * unshadowed(out);
                if (!scalar_) free_q += weight * 0.5 * (gain.pp - gain.ss) * turn * unshadowed(out);
            };
            add(gains.reflect, 2.0 * cosine * normal.z() - up);
            if (gains.cos_t > 0.0)
                add(gains.transmit, n_i / n_t * up - (n_i / n_t * cosine - gains.cos_t) * normal.z());
        }
    return {1.0 - free_i / all, -free_q / all};
}

}  // namespace patina::rt::monte_carlo
