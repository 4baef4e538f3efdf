#include "patina/rt/truncation.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace patina::rt {

namespace {

using optics::ExpansionCoefficients;

constexpr std::vector<double> ExpansionCoefficients::*all_coefficients[] = {
    &ExpansionCoefficients::alpha1, &ExpansionCoefficients::alpha2, &ExpansionCoefficients::alpha3,
    &ExpansionCoefficients::alpha4, &ExpansionCoefficients::beta1,  &ExpansionCoefficients::beta2};

// The share f of light that a peak takes when the expansion is cut to `terms`.
double forward_fraction(const ExpansionCoefficients& x, int terms) {
    // A negative share is a hole, as packing digs into the forward peak of coarse particles: light that is then missing
    // from it. The same algebra holds.
    return std::clamp(x.alpha1[terms] / (2.0 * terms + 1.0), -0.5, 1.0 - 1e-9);
}

ExpansionCoefficients without_peak(const ExpansionCoefficients& x, double f, int terms) {
    ExpansionCoefficients result;
    for (const auto list : all_coefficients) {
        const bool diagonal = list != &ExpansionCoefficients::beta1 && list != &ExpansionCoefficients::beta2;
        const bool linear = list == &ExpansionCoefficients::alpha2 || list == &ExpansionCoefficients::alpha3;
        (result.*list).assign((x.*list).begin(), (x.*list).begin() + terms);
        for (int l = 0; l < terms; ++l) {
            // d^l_22 begins at l = 2.
            if (diagonal && !(linear && l < 2)) (result.*list)[l] -= f * (2 * l + 1);
            (result.*list)[l] /= 1.0 - f;
        }
    }
    return result;
}

}  // namespace

double Truncation::scaled_depth(const Problem& whole, double depth) const {
    if (std::all_of(forward.begin(), forward.end(), [](double f) { return f == 0.0; })) return depth;
    double scaled_top = 0.0;
    for (std::size_t k = 0; k < whole.layers.size(); ++k) {
        const Layer& layer = whole.layers[k];
        if (depth <= layer.optical_thickness || k + 1 == whole.layers.size())
            return scaled_top + depth * (1.0 - forward[k] * layer.single_scattering_albedo);
        depth -= layer.optical_thickness;
        scaled_top += scaled.layers[k].optical_thickness;
    }
    return scaled_top;
}

Truncation truncate(const Problem& problem, int streams) {
    Truncation result{problem, std::vector<double>(problem.layers.size(), 0.0), {}, 0};
    result.lacking.resize(problem.layers.size());
    const int terms = 2 * streams;
    for (std::size_t k = 0; k < problem.layers.size(); ++k) {
        Layer& layer = result.scaled.layers[k];
        const ExpansionCoefficients& whole = problem.layers[k].expansion;
        if (whole.order() < terms || layer.single_scattering_albedo == 0.0) continue;

        const double f = forward_fraction(whole, terms), kept = 1.0 - layer.single_scattering_albedo * f;
        const double single = layer.single_scattering_albedo / kept;
        layer.expansion = without_peak(whole, f, terms);
        layer.optical_thickness *= kept;
        // Exactly 1 stays exactly 1.
        if (layer.single_scattering_albedo < 1.0) layer.single_scattering_albedo = single * (1.0 - f);
        result.forward[k] = f;

        result.order = std::max(result.order, whole.order());
        result.lacking[k] = whole;
        for (const auto list : all_coefficients)
            for (int l = 0; l <= whole.order(); ++l) {
                double& value = (result.lacking[k].*list)[l];
                value *= single;
                if (l < terms) value -= layer.single_scattering_albedo * (layer.expansion.*list)[l];
            }
    }
    return result;
}

void report_truncation(const Truncation& truncation, Diagnostics& diagnostics) {
    for (std::size_t k = 0; k < truncation.forward.size(); ++k)
        if (truncation.forward[k] > 0.0)
            diagnostics.notes.push_back(fmt::format(
                "layer {}: {:.2g} of its scattering, the forward peak, counts as unscattered (delta-M, {} terms)", k,
                truncation.forward[k], truncation.scaled.layers[k].expansion.order() + 1));
}

}  // namespace patina::rt
