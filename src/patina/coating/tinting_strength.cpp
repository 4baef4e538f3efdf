#include "patina/coating/tinting_strength.h"

#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "patina/coating/kubelka_munk.h"
#include "patina/coating/paint_metrics_colour.h"
#include "patina/core/error.h"
#include "patina/spectral/colour_difference.h"

namespace patina::coating {

namespace {

// Below this nothing is absorbed that the solver could tell from rounding.
constexpr double least_k_over_s = 1e-9;

struct EndlessFilm {
    std::vector<double> k_over_s;
    Eigen::Vector3d lab;
};

EndlessFilm endless_film(const Recipe& recipe, const StackOptions& options, const JobControl& control) {
    const VariableStack stack(recipe, options, control);
    if (!stack.layer().scatters)
        throw input_error({recipe.path}, "no layer scatters", "tinting strength is a ratio of K/S");
    const ReflectanceSpectra spectra = stack.solve(
        {{std::numeric_limits<double>::infinity()}, 0.0, VariableStack::Below::nothing, VariableStack::Above::nothing},
        control);
    EndlessFilm film;
    for (std::size_t w = 0; w < options.wavelengths_nm.size(); ++w) {
        SurfaceReflection surface;
        if (stack.has_interface()) surface = surface_reflection(stack.layer_index(static_cast<int>(w)), 8.0);
        const double r = std::min(1.0, saunderson_to_inner(spectra.d8_excluded[w], surface));
        if (!(r > 0.0))
            throw input_error({recipe.path},
                              fmt::format("the film reflects nothing at {:g} nm", options.wavelengths_nm[w]),
                              "tinting strength is a ratio of K/S");
        film.k_over_s.push_back((1.0 - r) * (1.0 - r) / (2.0 * r));
    }
    film.lab = lab(options.wavelengths_nm, spectra.d8_excluded, laboratory_viewing);
    return film;
}

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

TintingStrength tinting_strength(const Recipe& recipe, const Recipe& standard, const StackOptions& options,
                                 const JobControl& control) {
    const EndlessFilm paint = endless_film(recipe, options, control),
                      reference = endless_film(standard, options, control);
    const auto largest = std::max_element(reference.k_over_s.begin(), reference.k_over_s.end());
    if (*largest < least_k_over_s)
        throw input_error({standard.path}, "the standard absorbs nothing", "tinting strength is a ratio of K/S",
                          "compare paints that hold a coloured or black pigment");
    const auto w = static_cast<std::size_t>(largest - reference.k_over_s.begin());
    TintingStrength result;
    result.wavelength_nm = options.wavelengths_nm[w];
    result.at_maximum = paint.k_over_s[w] / *largest;
    result.integrated = sum(paint.k_over_s) / sum(reference.k_over_s);
    result.delta_e_2000 = spectral::delta_e_2000(paint.lab, reference.lab);
    result.k_over_s = paint.k_over_s;
    result.k_over_s_standard = reference.k_over_s;
    return result;
}

}  // namespace patina::coating
