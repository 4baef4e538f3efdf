#include "patina/optics/scattering/size_distribution.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/contract.h"

namespace patina::optics {

namespace {

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};

double power_of(SizeWeighting weighting) {
    return weighting == SizeWeighting::number ? 0.0 : weighting == SizeWeighting::area ? 2.0 : 3.0;
}

// ln of the density per ln r of the property, up to a constant; u = ln r. Smooth shapes only.
double log_density(const SizeShape& shape, double u) {
    return std::visit(Overloaded{[&](const LogNormal& s) {
                                     const double t = (u - std::log(s.median_radius_um)) / std::log(s.sigma_g);
                                     return -0.5 * t * t;
                                 },
                                 [&](const Gamma& s) {
                                     const double v = s.effective_variance;
                                     return u * ((1.0 - 3.0 * v) / v + 1.0) - std::exp(u) / (s.effective_radius_um * v);
                                 },
                                 [&](const ModifiedGamma& s) {
                                     return u * (s.alpha + 1.0) -
                                            s.alpha / s.gamma * std::exp(s.gamma * (u - std::log(s.mode_radius_um)));
                                 },
                                 [&](const PowerLaw& s) { return u * (1.0 - s.exponent); },
                                 [&](const RosinRammler& s) {
                                     const double t = s.spread * (u - std::log(s.scale_radius_um));
                                     return t - std::exp(t);
                                 },
                                 [](const auto&) { return 0.0; }},
                      shape);
}

// A radius near the bulk of the property, where searches start.
double typical_radius_um(const SizeShape& shape) {
    return std::visit(Overloaded{[](const Monodisperse& s) { return s.radius_um; },
                                 [](const LogNormal& s) { return s.median_radius_um; },
                                 [](const Gamma& s) { return s.effective_radius_um; },
                                 [](const ModifiedGamma& s) { return s.mode_radius_um; },
                                 [](const PowerLaw& s) { return s.min_radius_um; },
                                 [](const RosinRammler& s) { return s.scale_radius_um; },
                                 [](const Histogram& s) { return s.edges_um.front(); }},
                      shape);
}

// Slope of ln(density per ln r) at r -> 0; the integral down to zero is finite where it is positive.
double slope_at_zero(const SizeShape& shape) {
    return std::visit(
        Overloaded{[](const Gamma& s) { return (1.0 - 2.0 * s.effective_variance) / s.effective_variance; },
                   [](const ModifiedGamma& s) { return s.alpha + 1.0; }, [](const RosinRammler& s) { return s.spread; },
                   [](const auto&) { return 1e9; }},
        shape);
}

double argmax_of_concave(const std::function<double(double)>& f, double start) {
    // Walk uphill with growing steps to bracket the maximum.
    const double direction = f(start + 1e-3) > f(start - 1e-3) ? 1.0 : -1.0;
    double step = 0.1, left = start, right = start + direction * step;
    while (f(right) > f(left) && step < 1e3) {
        step *= 1.5;
        left = right;
        right += direction * step;
    }

    // Shrink the bracket by ternary sections, to far less than the width of a tail.
    double low = std::min(left - direction * step, std::min(start, right));
    double high = std::max(left, std::max(start, right));
    while (high - low > 1e-3) {
        const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
        (f(a) < f(b) ? low : high) = f(a) < f(b) ? a : b;
    }
    return 0.5 * (low + high);
}

// The argument on one side of the maximum where a concave f has fallen by `drop`.
double falls_by(const std::function<double(double)>& f, double drop, double start, double direction) {
    const double peak = argmax_of_concave(f, start);
    const double target = f(peak) - drop;
    double step = 0.05, inside = peak, outside = peak + direction * step;
    while (f(outside) > target && step < 1e3) {
        inside = outside;
        step *= 1.5;
        outside += direction * step;
    }
    for (int i = 0; i < 20; ++i) {
        const double middle = 0.5 * (inside + outside);
        (f(middle) > target ? inside : outside) = middle;
    }
    return outside;
}

// Stretches [0, 1] onto itself so that six derivatives vanish at both ends: the trapezoidal rule then converges like
// h^8 for any smooth integrand. The incomplete beta function I_t(7, 7).
struct Stretch {
    double value;
    double derivative;
};
Stretch stretch(double t) {
    const double s = t < 0.5 ? t : 1.0 - t;
    const double p = s * (1.0 - s);
    // I_s(7,7) = sum_j C(13,j) s^j (1-s)^(13-j), j = 7 .. 13.
    constexpr double binomials[] = {1716, 1287, 715, 286, 78, 13, 1};
    double sum = 0.0;
    for (int j = 0; j < 7; ++j) sum += binomials[j] * std::pow(s, 7 + j) * std::pow(1.0 - s, 6 - j);
    return {t < 0.5 ? sum : 1.0 - sum, 12012.0 * std::pow(p, 6)};
}

void require(bool legal, const SourceLocation& where, std::string_view problem, std::string_view why,
             std::string_view suggestion) {
    if (!legal) throw input_error(where, problem, why, suggestion);
}

bool positive(double value) {
    return std::isfinite(value) && value > 0.0;
}

void require_radius(double value, std::string_view name, const SourceLocation& where) {
    require(std::isfinite(value) && value >= 1e-6 && value <= 1e4, where, fmt::format("{} is {} um", name, value),
            "a radius lies between 1e-6 and 1e4 um",
            value > 1e4 ? "use at most 10000" : "use a positive radius in micrometres");
}

void validate_histogram(const Histogram& s, const SourceLocation& where) {
    require(!s.fractions.empty() && s.edges_um.size() == s.fractions.size() + 1, where,
            fmt::format("a histogram has {} edges and {} fractions", s.edges_um.size(), s.fractions.size()),
            "each fraction lies between two edges", "give one edge more than fractions");
    for (std::size_t i = 0; i < s.edges_um.size(); ++i) {
        require_radius(s.edges_um[i], fmt::format("edge {} of the histogram", i + 1), where);
        require(i == 0 || s.edges_um[i] > s.edges_um[i - 1], where,
                fmt::format("edge {} of the histogram is not above the one before it", i + 1), "edges ascend",
                "sort the edges");
    }
    double total = 0.0;
    for (double fraction : s.fractions) {
        require(std::isfinite(fraction) && fraction >= 0.0, where,
                fmt::format("a fraction of the histogram is {}", fraction), "fractions are not negative",
                "use 0 or more");
        total += fraction;
    }
    require(total > 0.0, where, "all fractions of the histogram are zero", "there are no particles",
            "give a positive one");
}

// Appends the points of one interval of ln r with a density given by its logarithm.
void append_stretched(RadiusRule& rule, double u_min, double u_max, double weight, int intervals, bool new_only,
                      const std::function<double(double)>& log_number) {
    const double width = u_max - u_min;
    for (int i = 1; i < intervals; i += new_only ? 2 : 1) {
        const Stretch s = stretch(static_cast<double>(i) / intervals);
        const double u = u_min + width * s.value;
        rule.radii_um.push_back(std::exp(u));
        rule.weights.push_back(weight * width * s.derivative / intervals * std::exp(log_number(u)));
    }
}

RadiusRule histogram_rule(const Histogram& histogram, double power, int intervals, bool new_only) {
    RadiusRule rule;
    for (std::size_t i = 0; i < histogram.fractions.size(); ++i) {
        if (histogram.fractions[i] == 0.0) continue;
        const double u_min = std::log(histogram.edges_um[i]), u_max = std::log(histogram.edges_um[i + 1]);
        append_stretched(rule, u_min, u_max, histogram.fractions[i] / (u_max - u_min), intervals, new_only,
                         [&](double u) { return -power * u; });
    }
    return rule;
}

// <r^3> and <r^2>, up to a common factor, and the number.
struct Moments {
    double number, square, cube;
};
Moments moments(const SizeDistribution& distribution) {
    // Every size is "large" (r^2) or "small" (r^6): a wavenumber beyond all radii makes r^2 rule, so widen by a
    // stricter tolerance.
    const RadiusRange range = relevant_range(distribution, 1.0 / typical_radius_um(distribution.shape), 1e-12);
    const RadiusRule rule = radius_rule(distribution, range, 512);
    Moments m{0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < rule.radii_um.size(); ++i) {
        const double r = rule.radii_um[i];
        m.number += rule.weights[i];
        m.square += rule.weights[i] * r * r;
        m.cube += rule.weights[i] * r * r * r;
    }
    return m;
}

}  // namespace

void validate(const SizeDistribution& distribution, const SourceLocation& where) {
    std::visit(
        Overloaded{[&](const Monodisperse& s) { require_radius(s.radius_um, "the radius", where); },
                   [&](const LogNormal& s) {
                       require_radius(s.median_radius_um, "the median radius", where);
                       require(std::isfinite(s.sigma_g) && s.sigma_g > 1.0 && s.sigma_g <= 10.0, where,
                               fmt::format("the geometric standard deviation is {}", s.sigma_g),
                               "it is the ratio of two radii, above 1 and at most 10",
                               s.sigma_g > 10.0 ? "use at most 10"
                                                : "use 1.3 for a paint grade, or monodisperse for one size");
                   },
                   [&](const Gamma& s) {
                       require_radius(s.effective_radius_um, "the effective radius", where);
                       require(s.effective_variance >= 1e-4 && s.effective_variance < 0.5, where,
                               fmt::format("the effective variance is {}", s.effective_variance),
                               "the gamma distribution exists from 0.0001 to below 0.5",
                               s.effective_variance >= 0.5 ? "use at most 0.49" : "use at least 0.0001");
                   },
                   [&](const ModifiedGamma& s) {
                       require_radius(s.mode_radius_um, "the mode radius", where);
                       require(positive(s.alpha) && s.alpha <= 1000.0, where, fmt::format("alpha is {}", s.alpha),
                               "a mode exists only for alpha above 0", "use a value above 0 and up to 1000");
                       require(positive(s.gamma) && s.gamma >= 0.05 && s.gamma <= 100.0, where,
                               fmt::format("gamma is {}", s.gamma), "it lies between 0.05 and 100",
                               s.gamma > 100.0 ? "use at most 100" : "use at least 0.05");
                   },
                   [&](const PowerLaw& s) {
                       require_radius(s.min_radius_um, "the smallest radius", where);
                       require_radius(s.max_radius_um, "the largest radius", where);
                       require(s.max_radius_um > s.min_radius_um, where, "the largest radius is not above the smallest",
                               "the cut-offs enclose the particles", "exchange them, or use monodisperse");
                       require(std::isfinite(s.exponent) && std::abs(s.exponent) <= 20.0, where,
                               fmt::format("the exponent is {}", s.exponent), "it lies between -20 and 20",
                               "use 3 to 4 for ground powders");
                   },
                   [&](const RosinRammler& s) {
                       require_radius(s.scale_radius_um, "the scale radius", where);
                       require(std::isfinite(s.spread) && s.spread >= 0.5 && s.spread <= 100.0, where,
                               fmt::format("the spread is {}", s.spread), "it lies between 0.5 and 100",
                               s.spread > 100.0 ? "use at most 100" : "use at least 0.5");
                   },
                   [&](const Histogram& s) { validate_histogram(s, where); }},
        distribution.shape);
}

RadiusRange relevant_range(const SizeDistribution& distribution, double wavenumber_per_um, double tolerance) {
    PATINA_EXPECT(wavenumber_per_um > 0.0 && tolerance > 0.0 && tolerance < 1.0);
    const SizeShape& shape = distribution.shape;
    if (const auto* s = std::get_if<Monodisperse>(&shape)) return {s->radius_um, s->radius_um};
    if (const auto* s = std::get_if<PowerLaw>(&shape)) return {s->min_radius_um, s->max_radius_um};
    if (const auto* s = std::get_if<Histogram>(&shape)) return {s->edges_um.front(), s->edges_um.back()};

    const double power = power_of(distribution.weighting);
    const double start = std::log(typical_radius_um(shape));
    const double drop = -std::log(0.1 * tolerance);
    const auto number = [&](double u) { return log_density(shape, u) - power * u; };

    // Cut the small particles where they matter neither in number nor in absorption (r^3).
    const auto absorption = [&](double u) { return number(u) + 3.0 * u - std::log1p(wavenumber_per_um * std::exp(u)); };
    const double u_min = slope_at_zero(shape) > power + 0.05 ? falls_by(number, drop, start, -1.0)
                                                             : falls_by(absorption, drop, start, -1.0);

    // Cut the large ones where their scattering no longer matters.
    const auto scattering = [&](double u) {
        const double x = wavenumber_per_um * std::exp(u);
        return number(u) + 6.0 * u - 2.0 * std::log1p(x * x);
    };
    return {std::exp(u_min), std::exp(falls_by(scattering, drop, start, 1.0))};
}

RadiusRule radius_rule(const SizeDistribution& distribution, const RadiusRange& range, int intervals,
                       bool new_points_only) {
    PATINA_EXPECT(intervals >= 2 && range.max_um >= range.min_um);
    const double power = power_of(distribution.weighting);
    if (const auto* s = std::get_if<Monodisperse>(&distribution.shape)) return {{s->radius_um}, {1.0}};
    if (const auto* s = std::get_if<Histogram>(&distribution.shape))
        return histogram_rule(*s, power, intervals, new_points_only);

    const double u_min = std::log(range.min_um), u_max = std::log(range.max_um);
    // Scale so that no density overflows: relative to the middle of the range.
    const double reference = log_density(distribution.shape, 0.5 * (u_min + u_max)) - power * 0.5 * (u_min + u_max);
    const auto log_number = [&](double u) { return log_density(distribution.shape, u) - power * u - reference; };
    RadiusRule rule;
    if (std::holds_alternative<PowerLaw>(distribution.shape)) {
        append_stretched(rule, u_min, u_max, 1.0, intervals, new_points_only, log_number);
        return rule;
    }
    const double step = (u_max - u_min) / intervals;
    for (int i = new_points_only ? 1 : 0; i <= intervals; i += new_points_only ? 2 : 1) {
        const double u = u_min + i * step;
        rule.radii_um.push_back(std::exp(u));
        rule.weights.push_back((i == 0 || i == intervals ? 0.5 : 1.0) * step * std::exp(log_number(u)));
    }
    return rule;
}

double mean_volume_um3(const SizeDistribution& distribution) {
    const Moments m = moments(distribution);
    return 4.0 / 3.0 * pi * m.cube / m.number;
}

double effective_radius_um(const SizeDistribution& distribution) {
    const Moments m = moments(distribution);
    return m.cube / m.square;
}

}  // namespace patina::optics
