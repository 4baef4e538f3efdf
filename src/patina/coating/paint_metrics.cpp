#include "patina/coating/paint_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "patina/coating/paint_metrics_colour.h"
#include "patina/core/contract.h"

namespace patina::coating {

namespace {

using Question = VariableStack::Question;

constexpr double infinite_thickness = std::numeric_limits<double>::infinity();
// No coat of paint is thinner or thicker, in um or in optical thickness.
constexpr double thinnest = 1e-4, thickest = 1e5;

struct BlackAndWhite {
    ReflectanceSpectra black, white;
};

BlackAndWhite over_cards(const VariableStack& stack, double thickness, double white_reflectance,
                         const JobControl& control) {
    Question question{{thickness}, 0.0};
    BlackAndWhite result;
    result.black = stack.solve(question, control);
    question.lambertian_base = white_reflectance;
    result.white = stack.solve(question, control);
    return result;
}

double luminous(const std::vector<double>& wavelengths_nm, const std::vector<double>& reflectance) {
    return tristimulus(wavelengths_nm, reflectance, laboratory_viewing)[1];
}

ContrastRatio contrast_ratio(const std::vector<double>& wavelengths_nm, const BlackAndWhite& cards) {
    const auto ratio = [&](const std::vector<double>& black, const std::vector<double>& white) {
        const double y_white = luminous(wavelengths_nm, white);
        return y_white > 0.0 ? std::max(0.0, luminous(wavelengths_nm, black) / y_white)
                             : 1.0;  // perfect blacks do not differ
    };
    return {ratio(cards.black.r45_0, cards.white.r45_0), ratio(cards.black.d8_excluded, cards.white.d8_excluded),
            ratio(cards.black.d8_included, cards.white.d8_included)};
}

std::string why_it_never_hides(const VariableStack& stack, const PaintOptions& options, double contrast) {
    if (contrast >= options.wanted_contrast_ratio) return "it hides however thin the layer is";
    if (!stack.layer().scatters) return "no layer scatters";
    return fmt::format("not even a layer of {:g} hides", thickest);
}

// Where to look first: five times the film whose reflectance is three quarters of the opaque one's. It does not depend
// on the recipe's thickness, so that neither does the answer.
double first_guess(const std::vector<FilmCoefficients>& film) {
    const double telling = film[film.size() / 2].kubelka_munk_thickness;
    return telling > 0.0 && std::isfinite(telling) ? std::clamp(5.0 * telling, thinnest, thickest) : 10.0;
}

HidingPower hiding_power(const Recipe& recipe, const VariableStack& stack, const PaintOptions& options, double contrast,
                         const std::vector<FilmCoefficients>& film, const JobControl& control) {
    HidingPower result;
    if (const auto* composition = std::get_if<Composition>(&recipe.layers[stack.layer().index].content)) {
        result.volume_solids_given = composition->volume_solids.has_value();
        result.volume_solids = composition->volume_solids.value_or(1.0);
    }
    int step = 0;
    const auto contrast_at = [&](double thickness) {
        control.report({"hiding power", ++step, 0, fmt::format("thickness {:.4g}", thickness)});
        return contrast_ratio(stack.wavelengths_nm(), over_cards(stack, thickness, options.white_reflectance, control))
            .r45_0;
    };
    if (stack.layer().scatters)
        result.thickness =
            hiding_thickness(contrast_at, options.wanted_contrast_ratio, first_guess(film), thinnest, thickest);
    if (!result.thickness)
        result.why_not = why_it_never_hides(stack, options, contrast);
    else if (!stack.layer().is_optical)
        result.spreading_rate_m2_per_l = 1000.0 * result.volume_solids / *result.thickness;  // 1 l on 1 m^2 is 1000 um
    return result;
}

// Where R0, without the surface, is about three quarters of the reflectivity: by two-flux theory with the S of
// diffusion, 3/4 of the transport scattering coefficient.
double telling_thickness(double reflectivity, double transport_scattering) {
    return kubelka_munk_scattering_power(0.75 * reflectivity, reflectivity) / (0.75 * transport_scattering);
}

std::vector<FilmCoefficients> film_coefficients(const VariableStack& stack, const JobControl& control) {
    const int count = static_cast<int>(stack.wavelengths_nm().size());
    std::vector<FilmCoefficients> film(count);
    std::vector<double> reflectivity(count, 0.0), thickness(count, 1.0);
    const Question alone{{infinite_thickness}, 0.0, VariableStack::Below::nothing, VariableStack::Above::nothing};
    const ReflectanceSpectra infinite = stack.layer().scatters ? stack.solve(alone, control) : ReflectanceSpectra{};
    for (int w = 0; w < count; ++w) {
        film[w].transport_scattering = stack.transport_scattering(w);
        film[w].absorption = stack.absorption(w);
        if (stack.has_interface()) film[w].surface = surface_reflection(stack.layer_index(w), 8.0);
        if (film[w].transport_scattering <= 0.0) continue;
        // Rounding and the angular quadrature may lift a conservative layer above 1.
        reflectivity[w] = std::min(1.0, saunderson_to_inner(infinite.d8_excluded[w], film[w].surface));
        if (reflectivity[w] > 0.0) thickness[w] = telling_thickness(reflectivity[w], film[w].transport_scattering);
    }
    if (!stack.layer().scatters) return film;

    Question thin = alone;
    thin.thickness = thickness;
    const ReflectanceSpectra r0 = stack.solve(thin, control);
    for (int w = 0; w < count; ++w) {
        film[w].kubelka_munk_thickness = thickness[w];
        film[w].kubelka_munk =
            kubelka_munk_from(saunderson_to_inner(r0.d8_excluded[w], film[w].surface), reflectivity[w], thickness[w]);
    }
    return film;
}

}  // namespace

std::optional<double> hiding_thickness(const std::function<double(double)>& contrast_ratio, double wanted, double start,
                                       double smallest, double largest) {
    PATINA_EXPECT(wanted > 0.0 && wanted < 1.0 && smallest > 0.0 && start > 0.0 && smallest < largest);
    // The logarithm of what is left of the contrast falls almost evenly with the logarithm of the thickness.
    constexpr double nothing_left = -40.0;
    const auto excess = [&](double log_thickness) {
        const double left = 1.0 - contrast_ratio(std::exp(log_thickness));
        return left > 0.0 ? std::max(nothing_left, std::log(left / (1.0 - wanted))) : nothing_left;
    };

    // Bracket the root: thin (excess > 0) to thick (excess <= 0). A slope of -1 is that of a conservative white.
    const double low = std::log(smallest), high = std::log(largest);
    double x = std::clamp(std::log(start), low, high), f = excess(x);
    double thin = x, thick = x, f_thin = f, f_thick = f;
    while (f_thin <= 0.0 || f_thick > 0.0) {
        const double next = std::clamp(x + std::clamp(1.3 * f + (f > 0.0 ? 0.05 : -0.05), -3.0, 3.0), low, high);
        if (next == x) return std::nullopt;
        x = next;
        f = excess(x);
        (f > 0.0 ? thin : thick) = x;
        (f > 0.0 ? f_thin : f_thick) = f;
    }

    // False position with Illinois' halving (Dowell & Jarratt 1971).
    constexpr double relative_error = 1e-4;
    int side = 0;
    for (int step = 0; step < 60 && thick - thin > relative_error; ++step) {
        x = thin + (thick - thin) * f_thin / (f_thin - f_thick);
        f = excess(x);
        if (std::abs(f) < 0.1 * relative_error) return std::exp(x);
        if (f > 0.0) {
            thin = x;
            f_thin = f;
            if (side == 1) f_thick *= 0.5;
            side = 1;
        } else {
            thick = x;
            f_thick = f;
            if (side == -1) f_thin *= 0.5;
            side = -1;
        }
    }
    return std::exp(x);
}

PaintMetrics paint_metrics(const Recipe& recipe, const PaintOptions& options, const JobControl& control) {
    const VariableStack stack(recipe, options.stack, control);
    const std::vector<double>& wavelengths = stack.wavelengths_nm();
    PaintMetrics result;
    result.wavelengths_nm = wavelengths;
    result.thickness = stack.thickness();
    result.thickness_is_optical = stack.layer().is_optical;
    result.white_reflectance = options.white_reflectance;
    result.wanted_contrast_ratio = options.wanted_contrast_ratio;
    result.layer = stack.layer().index;
    result.streams = stack.streams();
    result.streams_are_exact = stack.streams_are_exact();
    result.notes = stack.notes();

    result.own = stack.solve({{stack.thickness()}, std::nullopt}, control);
    BlackAndWhite cards = over_cards(stack, stack.thickness(), options.white_reflectance, control);
    result.contrast = contrast_ratio(wavelengths, cards);
    result.over_black = std::move(cards.black);
    result.over_white = std::move(cards.white);
    result.infinite = stack.solve({{infinite_thickness}, 0.0}, control);
    result.film = film_coefficients(stack, control);
    result.hiding = hiding_power(recipe, stack, options, result.contrast.r45_0, result.film, control);
    result.converged = stack.converged();
    return result;
}

}  // namespace patina::coating
