#pragma once
// Size distributions of spherical particles, and quadratures over them.
//
// A shape is a density f(r) of the property named by its weighting: of number, projected area or volume. Densities of
// area and volume are converted to number by n(r) = f(r)/r^2 or f(r)/r^3. Radii in um.

#include <string>
#include <variant>
#include <vector>

#include "patina/core/error.h"

namespace patina::optics {

enum class SizeWeighting { number, area, volume };

// All particles have one radius.
struct Monodisperse {
    double radius_um;
};

// f ~ exp(-(ln(r/median))^2 / (2 ln^2 sigma_g)) / r; half of the property lies below the median.
struct LogNormal {
    double median_radius_um;
    double sigma_g;  // geometric standard deviation, > 1
};

// f ~ r^((1-3v)/v) exp(-r/(r_eff v)), 0 < v < 1/2 (Hansen & Travis 1974, eq. 2.56). r_eff and v_eff are the effective
// radius and variance of the distribution when f is by number.
struct Gamma {
    double effective_radius_um;
    double effective_variance;
};

// f ~ r^alpha exp(-(alpha/gamma) (r/r_c)^gamma), r_c the mode (Deirmendjian 1969). Haze L: alpha 2, gamma 1/2, r_c 0.07
// um.
struct ModifiedGamma {
    double alpha;
    double gamma;
    double mode_radius_um;
};

// f ~ r^(-exponent) between two radii.
struct PowerLaw {
    double exponent;
    double min_radius_um;
    double max_radius_um;
};

// The fraction above r is exp(-(r/scale)^spread) (Rosin & Rammler 1933; Weibull).
struct RosinRammler {
    double scale_radius_um;
    double spread;
};

// fractions[i] of the property between edges_um[i] and edges_um[i+1], spread evenly over ln r.
struct Histogram {
    std::vector<double> edges_um;   // ascending, one more than fractions
    std::vector<double> fractions;  // >= 0, need not add up to 1
};

using SizeShape = std::variant<Monodisperse, LogNormal, Gamma, ModifiedGamma, PowerLaw, RosinRammler, Histogram>;

struct SizeDistribution {
    SizeShape shape;
    SizeWeighting weighting = SizeWeighting::number;
};

// Throws Error(input) at `where`, naming the parameter and its nearest legal value.
void validate(const SizeDistribution& distribution, const SourceLocation& where = {});

// Where a distribution matters.
struct RadiusRange {
    double min_um;
    double max_um;
};

// The radii beyond which the contributions to number and to cross sections fall below about `tolerance` of the whole.
// Cross sections are taken to grow like r^6 up to a size parameter of one and like r^2 from there. The number below the
// range counts only if it is finite: a Rosin-Rammler distribution by volume with a spread below 3 has infinitely many
// vanishing particles, which no one sees. `wavenumber_per_um` is 2 pi n_host / lambda.
RadiusRange relevant_range(const SizeDistribution& distribution, double wavenumber_per_um, double tolerance);

// Radii and number weights (not normalised) of a nested rule: `intervals` a power of two; the points of one rule are
// points of the next, and `new_points_only` leaves out those of the rule with half the intervals. In ln r, the
// trapezoidal rule, which converges exponentially for densities that vanish at both ends; a density with sharp edges is
// first stretched so that it does (Sag & Szekeres 1964). Monodisperse: one point.
struct RadiusRule {
    std::vector<double> radii_um;
    std::vector<double> weights;
};
RadiusRule radius_rule(const SizeDistribution& distribution, const RadiusRange& range, int intervals,
                       bool new_points_only = false);

// Moments over a rule fine enough for 1e-10.
double mean_volume_um3(const SizeDistribution& distribution);      // <4/3 pi r^3> per particle
double effective_radius_um(const SizeDistribution& distribution);  // <r^3>/<r^2>

}  // namespace patina::optics
