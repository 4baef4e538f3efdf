#pragma once
// What a paint laboratory reads off a drawdown: hiding, reflectance over black and white, Kubelka-Munk coefficients.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "patina/coating/kubelka_munk.h"
#include "patina/coating/paint_metrics_stack.h"

namespace patina::coating {

struct PaintOptions {
    StackOptions stack;
    // Of the white card, Lambertian and in optical contact with the film; 0.80 is what ISO 6504-1 and ASTM D2805 refer
    // contrast ratios to. The black card is perfectly black.
    double white_reflectance = 0.80;
    double wanted_contrast_ratio = 0.98;
};

// Luminous reflectance over black / over white, Y of D65 and the 10 degree observer.
struct ContrastRatio {
    double r45_0 = 0.0, d8_excluded = 0.0, d8_included = 0.0;
};

// The film that just hides: contrast ratio 45:0 equal to the wanted one.
struct HidingPower {
    // Dry film thickness of the variable layer; in optical thickness when the layer is given in optical terms. Nothing
    // when no thickness hides, with the reason in `why_not`.
    std::optional<double> thickness;
    std::optional<double> spreading_rate_m2_per_l;  // volume_solids / thickness; nothing for a layer in optical terms
    double volume_solids = 1.0;
    bool volume_solids_given = false;  // else the rate is that of a litre of dry paint
    std::string why_not;
};

// The variable layer by itself, with a top surface of the recipe's kind, at one wavelength.
struct FilmCoefficients {
    // From R0 and R_inf, d:8 with specular excluded, each freed of its surface by Saunderson's correction. R0 is taken
    // at the thickness where it is about three quarters of R_inf: a thin film's reflectance is not of two fluxes, and
    // an opaque film's tells nothing of S. Nothing when the film reflects too little.
    std::optional<KubelkaMunk> kubelka_munk;
    double kubelka_munk_thickness = 0.0;  // where R0 was taken
    SurfaceReflection surface;            // k1 at 8 degrees, k2
    double transport_scattering = 0.0;    // sigma_s (1 - g)
    double absorption = 0.0;              // sigma_a
};

struct PaintMetrics {
    std::vector<double> wavelengths_nm;
    double thickness = 0.0;             // of the variable layer in the recipe
    bool thickness_is_optical = false;  // else in um; coefficients are per unit of the same
    ReflectanceSpectra own;             // over the recipe's own base
    ReflectanceSpectra over_black, over_white;
    ReflectanceSpectra infinite;  // the variable layer without end
    double white_reflectance = 0.0, wanted_contrast_ratio = 0.0;
    ContrastRatio contrast;
    HidingPower hiding;
    std::vector<FilmCoefficients> film;  // a wavelength each
    int layer = 0;                       // which layer varies
    int streams = 0;
    bool streams_are_exact = true;  // for the phase functions; else forward peaks were truncated
    bool converged = true;
    std::vector<std::string> notes;
};

// Throws Error(input) for what the recipe or the solver cannot do, Error(interrupted) when stopped.
PaintMetrics paint_metrics(const Recipe& recipe, const PaintOptions& options, const JobControl& control = {});

// The thickness at which an increasing contrast ratio reaches `wanted`, to 1e-4 of it, searched from `start` between
// `smallest` and `largest`; nothing when it is not there.
std::optional<double> hiding_thickness(const std::function<double(double thickness)>& contrast_ratio, double wanted,
                                       double start, double smallest, double largest);

}  // namespace patina::coating
