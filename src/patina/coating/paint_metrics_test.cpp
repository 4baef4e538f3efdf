#include "patina/coating/paint_metrics.h"

#include <cmath>
#include <limits>

#include "patina/coating/paint_metrics_colour.h"
#include "patina/core/error.h"

namespace patina::coating {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// A layer that scatters isotropically and knows no polarization, without an interface.
Recipe isotropic(double optical_thickness, double albedo) {
    OpticalLayer layer{optical_thickness, albedo, {}, 1.0};
    layer.expansion = {{1.0}, {0.0}, {0.0}, {0.0}, {0.0}, {0.0}};
    Recipe recipe;
    recipe.layers.push_back({"", layer});
    return recipe;
}

const std::string paint_text = R"(
[interface]
type = "smooth"
[[layers]]
thickness_um = 10
binder = { n = 1.5, k = 1e-6 }
[[layers.pigments]]
material = { n = 2.75 }
volume_fraction = 0.15
size = { distribution = "mono", radius_um = 0.1 }
)";

PaintOptions at_550() {
    PaintOptions options;
    options.stack.wavelengths_nm = {550.0};
    return options;
}

PaintMetrics metrics_of(const std::vector<std::string>& settings = {}) {
    return paint_metrics(parse_recipe(paint_text, "paint.toml", ".", settings), at_550());
}

// Diffuse light through a thick conservative slab: 1/T = 3/4 (tau + 2 q), q = 0.710446 Hopf's constant (Chandrasekhar
// 1960); Kubelka and Munk's 1/T = 1 + S d has the same slope for S = 3/4.
TEST(PaintMetrics, ConservativeScatteringPowerIsThreeQuartersOfOpticalThickness) {
    const Recipe recipe = isotropic(20.0, 1.0);
    PaintOptions options = at_550();
    options.stack.streams = 24;
    const VariableStack stack(recipe, options.stack);
    const auto inverse_transmittance = [&](double tau) {
        return 1.0 / (1.0 - stack.solve({{tau}, 0.0}).bihemispherical[0]);
    };
    // What is left of the boundary layers at tau = 20 is exp(-20).
    EXPECT_NEAR((inverse_transmittance(40.0) - inverse_transmittance(20.0)) / 20.0, 0.75, 1e-6);
    // q has six digits.
    EXPECT_NEAR(inverse_transmittance(20.0), 0.75 * (20.0 + 2 * 0.710446), 1e-6);
}

// Diffusion: K = 2 sigma_a, S = 3/4 sigma_s, so K/S = 8/3 (1 - albedo)/albedo, with an error of the order of
// sqrt(1 - albedo).
TEST(PaintMetrics, WeaklyAbsorbingReflectivityHasTheKOverSOfDiffusion) {
    for (const double loss : {1e-4, 1e-6, 1e-8}) {
        const Recipe recipe = isotropic(1.0, 1.0 - loss);
        const VariableStack stack(recipe, at_550().stack);
        const double r = stack.solve({{infinite}, 0.0}).bihemispherical[0];
        EXPECT_NEAR((1 - r) * (1 - r) / (2 * r) / (8.0 / 3.0 * loss), 1.0, 3.0 * std::sqrt(loss) + 1e-3) << loss;
    }
}

TEST(PaintMetrics, ContrastRatioRunsFromNothingToOne) {
    const Recipe recipe = isotropic(infinite, 0.99);
    EXPECT_NEAR(paint_metrics(recipe, at_550()).contrast.r45_0, 1.0, 1e-14);
    double previous = 0.0;
    for (const char* thickness : {"0.01", "1", "5", "10", "40", "200"}) {
        const PaintMetrics m = metrics_of({std::string("layers.0.thickness_um=") + thickness});
        EXPECT_GT(m.contrast.r45_0, previous) << thickness;
        EXPECT_LT(m.contrast.r45_0, 1.0) << thickness;
        previous = m.contrast.r45_0;
    }
    // The contrast left falls with the inverse square of the thickness at the slowest: 7.5e-7 of a card is left at 200
    // um.
    EXPECT_GT(previous, 0.999);
    EXPECT_LT(metrics_of({"layers.0.thickness_um=0.01"}).contrast.r45_0, 0.05);
}

TEST(PaintMetrics, TheHidingFilmHasTheWantedContrast) {
    const PaintMetrics m = metrics_of();
    ASSERT_TRUE(m.hiding.thickness);
    const PaintMetrics hiding = metrics_of({"layers.0.thickness_um=" + std::to_string(*m.hiding.thickness)});
    EXPECT_NEAR(hiding.contrast.r45_0, 0.98, 1e-5);  // thickness to 1e-4, left of the contrast 0.02
    EXPECT_NEAR(*m.hiding.spreading_rate_m2_per_l, 1000.0 / *m.hiding.thickness, 1e-12);
    // It is a property of the paint, not of the coat the recipe happens to have.
    EXPECT_EQ(*metrics_of({"layers.0.thickness_um=300"}).hiding.thickness, *m.hiding.thickness);
}

// A coat of another thickness or over another base asks some of the same questions; remembered answers have the bits of
// computed ones.
TEST(PaintMetrics, RememberedAnswersHaveTheSameBits) {
    PaintOptions series = at_550();
    series.stack.memory = std::make_shared<StackMemory>();
    series.stack.composition = "the paint";
    for (const char* thickness : {"10", "3"}) {
        const std::vector<std::string> settings{std::string("layers.0.thickness_um=") + thickness};
        const Recipe recipe = parse_recipe(paint_text, "paint.toml", ".", settings);
        const PaintMetrics remembered = paint_metrics(recipe, series, {}), alone = metrics_of(settings);
        EXPECT_EQ(remembered.own.r45_0, alone.own.r45_0);
        EXPECT_EQ(remembered.over_white.d8_included, alone.over_white.d8_included);
        EXPECT_EQ(remembered.infinite.bihemispherical, alone.infinite.bihemispherical);
        EXPECT_EQ(*remembered.hiding.thickness, *alone.hiding.thickness);
        EXPECT_EQ(remembered.film[0].kubelka_munk->s, alone.film[0].kubelka_munk->s);
        EXPECT_EQ(remembered.contrast.d8_included, alone.contrast.d8_included);
    }
    // The second coat asked anew only for what depends on its thickness: over its base, which is as black as the black
    // card, and over white. The whole search for the hiding film was known.
    EXPECT_GE(series.stack.memory->answers_found(), 10u);
}

TEST(PaintMetrics, MorePigmentHidesMoreAndVolumeSolidsScale) {
    const auto rate = [](const std::vector<std::string>& settings) {
        return *metrics_of(settings).hiding.spreading_rate_m2_per_l;
    };
    const double standard = rate({});
    EXPECT_LT(rate({"layers.0.pigments.0.volume_fraction=0.05"}), standard);
    EXPECT_NEAR(rate({"volume_solids=0.4"}) / standard, 0.4, 1e-12);
    EXPECT_NEAR(rate({"volume_solids=0.4", "layers.0.volume_solids=0.3"}) / standard, 0.3, 1e-12);
    EXPECT_TRUE(metrics_of({"volume_solids=0.4"}).hiding.volume_solids_given);
    EXPECT_FALSE(metrics_of().hiding.volume_solids_given);
}

TEST(PaintMetrics, AVarnishHidesNothing) {
    const PaintMetrics m = metrics_of({"layers.0.pigments=[]"});
    EXPECT_FALSE(m.hiding.thickness);
    EXPECT_THAT(m.hiding.why_not, ::testing::HasSubstr("no layer scatters"));
    EXPECT_NEAR(m.contrast.r45_0, 0.0, 1e-14);
    EXPECT_FALSE(m.film[0].kubelka_munk);
}

// Below nothing at all, the cards show their own reflectance.
TEST(PaintMetrics, TheCardsReflectWhatTheyShould) {
    const Recipe clear = parse_recipe("[[layers]]\nthickness_um = 10\nbinder = { n = 1.5 }\n", "clear.toml", ".");
    const PaintMetrics m = paint_metrics(clear, at_550());
    // Rounding of sums over the nodes and of the interpolation between them.
    for (const std::vector<double>* white :
         {&m.over_white.r45_0, &m.over_white.d8_excluded, &m.over_white.d8_included, &m.over_white.bihemispherical})
        EXPECT_NEAR((*white)[0], 0.80, 1e-12);
    EXPECT_EQ(m.over_black.r45_0[0], 0.0);
}

// Saunderson's correction takes the surface off: what is left is the film between diffuse lights, which two fluxes are
// about. A beam refracted at 8 degrees is not diffuse, which costs S an eighth here.
TEST(PaintMetrics, SaundersonTakesTheSurfaceOff) {
    const FilmCoefficients film = metrics_of().film[0];
    ASSERT_TRUE(film.kubelka_munk);
    const Recipe bare = parse_recipe(paint_text.substr(paint_text.find("[[layers]]")), "paint.toml", ".");
    const VariableStack stack(bare, at_550().stack);
    const auto diffuse =
        kubelka_munk_from(stack.solve({{film.kubelka_munk_thickness}, 0.0}).bihemispherical[0],
                          stack.solve({{infinite}, 0.0}).bihemispherical[0], film.kubelka_munk_thickness);
    ASSERT_TRUE(diffuse);
    EXPECT_NEAR(film.kubelka_munk->s / diffuse->s, 1.0, 0.15);
    // Diffusion's S = 3/4 sigma_s (1 - g) at three quarters of full reflectance, where boundary layers still count.
    EXPECT_NEAR(diffuse->s / (0.75 * film.transport_scattering), 1.0, 0.05);
    // Uncorrected, the same film would seem to scatter less than half as much.
    const double uncorrected = kubelka_munk_scattering_power(
        saunderson_from_inner(kubelka_munk_reflectance(*film.kubelka_munk, film.kubelka_munk_thickness, 0.0),
                              film.surface),
        1.0);
    EXPECT_LT(uncorrected / film.kubelka_munk_thickness, 0.5 * diffuse->s);
    EXPECT_NEAR(film.surface.k2, 0.596, 5e-4);
}

// A conservative film without end returns all light: with its surface, d:8 specular included is 1.
TEST(PaintMetrics, ConservativeFilmWithoutEndIsPerfectlyWhite) {
    const PaintMetrics m = metrics_of({"layers.0.binder={ n = 1.5 }"});
    // Interpolation to 8 degrees between the nodes.
    EXPECT_NEAR(m.infinite.d8_included[0], 1.0, 1e-4);
    EXPECT_EQ(m.infinite.d8_included[0] > m.infinite.d8_excluded[0], true);
}

// An extender that scatters forward needs fewer streams than its phase function has terms: truncated forward peaks and
// exact single scattering leave the reflectances within the tolerance of those of all streams.
TEST(PaintMetrics, CoarseParticlesNeedFewerStreamsThanTheirPhaseFunctions) {
    const std::vector<std::string> coarse = {
        "layers.0.pigments.0.material={ n = 1.62 }",
        "layers.0.pigments.0.size={ distribution = \"lognormal\", median_radius_um = 0.6, sigma_g = 1.15 }",
        "layers.0.thickness_um=40"};
    const Recipe recipe = parse_recipe(paint_text, "paint.toml", ".", coarse);
    PaintOptions options = at_550();
    options.stack.streams = 60;
    const PaintMetrics all = paint_metrics(recipe, options);
    EXPECT_TRUE(all.streams_are_exact);
    options.stack.streams = 0;
    for (const double tolerance : {1e-3, 1e-5}) {
        options.stack.tolerance = tolerance;
        const PaintMetrics chosen = paint_metrics(recipe, options);
        EXPECT_FALSE(chosen.streams_are_exact);
        EXPECT_LT(chosen.streams, 40) << tolerance;
        // The sizes are averaged to a tenth of the tolerance.
        const double allowed = tolerance * all.infinite.r45_0[0] + (tolerance < 1e-3 ? 1e-5 : 0.0);
        EXPECT_NEAR(chosen.over_black.r45_0[0], all.over_black.r45_0[0], allowed);
        EXPECT_NEAR(chosen.over_black.d8_excluded[0], all.over_black.d8_excluded[0], allowed);
        EXPECT_NEAR(chosen.over_white.bihemispherical[0], all.over_white.bihemispherical[0], allowed);
        EXPECT_NEAR(chosen.infinite.d8_included[0], all.infinite.d8_included[0], allowed);
    }
}

TEST(HidingThickness, FindsTheRootOfAKnownFilm) {
    // Kubelka and Munk without absorption, S = 1: R0 = d/(1+d) over black.
    const auto contrast = [](double d) {
        return kubelka_munk_reflectance({0.0, 1.0}, d, 0.0) / kubelka_munk_reflectance({0.0, 1.0}, d, 0.8);
    };
    double exact = 1.0;
    for (double low = 1.0, high = 100.0; high - low > 1e-12;) {
        exact = 0.5 * (low + high);
        (contrast(exact) < 0.98 ? low : high) = exact;
    }
    for (const double start : {1e-3, 1.0, 10.0, 1e4}) {
        const auto found = hiding_thickness(contrast, 0.98, start, 1e-4, 1e5);
        ASSERT_TRUE(found);
        EXPECT_NEAR(*found / exact, 1.0, 1.01e-4) << start;
    }
    EXPECT_FALSE(hiding_thickness([](double) { return 0.5; }, 0.98, 1.0, 1e-4, 1e5));
    EXPECT_FALSE(hiding_thickness([](double) { return 1.0; }, 0.98, 1.0, 1e-4, 1e5));
}

TEST(PaintColour, ThePerfectDiffuserIsWhiteInEveryLight) {
    const std::vector<double> wavelengths{400, 500, 600, 700}, ones(4, 1.0);
    for (const Viewing& viewing : usual_viewings())
        EXPECT_LT((lab(wavelengths, ones, viewing) - Eigen::Vector3d(100, 0, 0)).norm(), 1e-9);
    // The coefficients of the standard leave 0.1 of whiteness and 0.05 of yellowness.
    const WhitenessAndYellowness w = whiteness(wavelengths, ones);
    EXPECT_NEAR(w.whiteness, 100.0, 0.13);
    EXPECT_NEAR(w.yellowness, 0.0, 0.05);
}

}  // namespace
}  // namespace patina::coating
