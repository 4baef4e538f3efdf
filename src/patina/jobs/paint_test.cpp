#include "patina/jobs/paint.h"

#include "patina/brdf/tabulate.h"
#include "patina/coating/paint_metrics_colour.h"
#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/jobs/solve.h"
#include "patina/optics/fresnel.h"

namespace patina::jobs {
namespace {

brdf::MuellerTable lambertian(double reflectance) {
    brdf::TabulateOptions options;
    options.wavelengths_nm = {400.0, 700.0};
    return brdf::tabulate(brdf::lambertian_body(reflectance), options);
}

// A perfect diffuser looks the same from everywhere, and does not shine.
TEST(Paint, PerfectDiffuserIsWhiteAtEveryAngle) {
    const brdf::MuellerTable table = lambertian(1.0);
    // Rounding of the interpolation.
    EXPECT_LT((lab_45_0(table) - Eigen::Vector3d(100, 0, 0)).norm(), 1e-6);
    const std::vector<AspecularColour> colours = aspecular_colours(table);
    ASSERT_EQ(colours.size(), 5u);
    for (const AspecularColour& colour : colours)
        EXPECT_LT((colour.lab - Eigen::Vector3d(100, 0, 0)).norm(), 1e-6) << colour.aspecular_deg;
    for (const Gloss& value : gloss(table)) EXPECT_EQ(value.gloss_units, 0.0);
}

// L* of a grey of Y = 0.184187 is 50 (the cube of 66/116).
TEST(Paint, GreyHasTheLightnessOfItsReflectance) {
    EXPECT_NEAR(lab_45_0(lambertian(std::pow(66.0 / 116.0, 3)))[0], 50.0, 1e-6);
}

const std::string paint_text = R"(
[interface]
type = "smooth"
[[layers]]
thickness_um = 10
binder = { n = INDEX, k = 1e-6 }
[[layers.pigments]]
material = { n = 2.75 }
volume_fraction = 0.15
size = { distribution = "mono", radius_um = 0.1 }
[base]
type = "lambertian"
reflectance = 0.3
)";

coating::Recipe recipe_of_index(const std::string& index) {
    std::string text = paint_text;
    text.replace(text.find("INDEX"), 5, index);
    return coating::parse_recipe(text, "paint.toml", ".");
}

// The order 0 alone gives the same numbers as the whole BRDF.
TEST(Paint, MetricsAgreeWithTheWholeTable) {
    const coating::Recipe recipe = recipe_of_index("1.5");
    PaintRequest request;
    request.options.stack.wavelengths_nm = {550.0};
    const PaintReport report = paint(recipe, request);
    SolveRequest whole;
    whole.wavelengths_nm = {550.0};
    whole.streams = report.metrics.streams;
    const brdf::MuellerTable table = solve(recipe, whole).table;
    const double mu_8 = std::cos(radians(8.0));
    // Two routes through the same nodes; their phase functions are cut off at tolerances a factor ten apart, both below
    // 1e-4. By reciprocity d:8 is the directional-hemispherical reflectance at 8.
    EXPECT_NEAR(report.metrics.own.d8_excluded[0], table.body_albedo(550.0, mu_8), 1e-6);
    // Even orders vanish along the normal; interpolated between nodes they leave 3e-8.
    EXPECT_NEAR(report.metrics.own.r45_0[0], pi * table.evaluate(550.0, 1.0, std::sqrt(0.5), 0.0)(0, 0), 1e-6);
    EXPECT_NEAR(report.metrics.own.d8_included[0] - report.metrics.own.d8_excluded[0],
                optics::fresnel_reflection(mu_8, 1.0, 1.5)(0, 0), 1e-14);
    // 45as45 is the view along the normal.
    EXPECT_NEAR(report.aspecular[2].reflectance[0], report.metrics.own.r45_0[0], 1e-6);
}

// The surface of the black glass itself has 100 gloss units at every angle (ISO 2813).
TEST(Paint, ASurfaceOfTheIndexOfBlackGlassHasAHundredGlossUnits) {
    PaintRequest request;
    request.options.stack.wavelengths_nm = {550.0};
    // The table keeps the specular part every half degree and interpolates it by cubics.
    for (const Gloss& value : paint(recipe_of_index("1.567"), request).gloss)
        EXPECT_NEAR(value.gloss_units, 100.0, 1e-3) << value.theta_deg;
}

TEST(Paint, DistanceToItsOwnColourIsNothing) {
    PaintRequest request;
    request.angular = false;
    request.options.stack.wavelengths_nm = {450.0, 650.0};
    const coating::Recipe recipe = recipe_of_index("1.5");
    const coating::PaintMetrics m = paint(recipe, request).metrics;
    request.target_lab = coating::lab(m.wavelengths_nm, m.own.r45_0, coating::laboratory_viewing);
    EXPECT_EQ(*paint(recipe, request).delta_e_2000, 0.0);
}

TEST(Paint, RefusesWhatNoLaboratoryHas) {
    PaintRequest request;
    request.options.white_reflectance = 1.5;
    EXPECT_THROW(paint(recipe_of_index("1.5"), request), Error);
    request.options.white_reflectance = 0.8;
    request.options.wanted_contrast_ratio = 1.0;
    EXPECT_THROW(paint(recipe_of_index("1.5"), request), Error);
}

}  // namespace
}  // namespace patina::jobs
