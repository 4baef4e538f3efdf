// Recipes whose pigments are given in other ways than spheres of a volume fraction.

#include <fstream>

#include "patina/coating/optical_problem.h"
#include "patina/coating/recipe.h"
#include "patina/core/constants.h"
#include "patina/core/scratch_folder_for_tests.h"
#include "patina/optics/scattering/expansion.h"
#include "patina/optics/scattering/mixture.h"

namespace patina::coating {
namespace {

using ::testing::HasSubstr;

std::string layer(const std::string& pigment, const std::string& more = "") {
    return "[[layers]]\nthickness_um = 10\nbinder = { n = 1.5 }\n" + more + "[[layers.pigments]]\n" + pigment;
}
const std::string titania = "material = { n = 2.7 }\nsize = { distribution = \"mono\", radius_um = 0.1 }\n";

double fraction_of(const std::string& concentration, const std::string& more = "",
                   const std::vector<std::string>& settings = {}) {
    const Recipe recipe = parse_recipe(layer(titania + concentration, more), "r.toml", ".", settings);
    return std::get<Composition>(recipe.layers[0].content).pigments[0].volume_fraction;
}

std::string message_of(const std::string& text, const std::vector<std::string>& settings = {}) {
    try {
        parse_recipe(text, "r.toml", ".", settings);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(PigmentConcentration, IsReadInEveryWay) {
    EXPECT_DOUBLE_EQ(fraction_of("volume_fraction = 0.2"), 0.2);
    EXPECT_DOUBLE_EQ(fraction_of("pvc_percent = 20"), 0.2);
    EXPECT_DOUBLE_EQ(fraction_of("weight_percent = 50\ndensity_g_cm3 = 4", "binder_density_g_cm3 = 1\n"), 0.2);
    EXPECT_NEAR(fraction_of("number_density_per_um3 = 10"), 10 * 4.0 / 3.0 * pi * 1e-3, 1e-15);
}

TEST(PigmentConcentration, ASettingTakesThePlaceOfAnotherWay) {
    EXPECT_DOUBLE_EQ(fraction_of("volume_fraction = 0.2", "", {"layers.0.pigments.0.pvc_percent=5"}), 0.05);
    EXPECT_DOUBLE_EQ(fraction_of("pvc_percent = 20", "", {"layers.0.pigments.0.volume_fraction=0.01"}), 0.01);
}

TEST(PigmentConcentration, SaysWhatIsWrong) {
    const auto of = [](const std::string& c, const std::string& more = "") {
        return message_of(layer(titania + c, more));
    };
    EXPECT_THAT(of(""), HasSubstr("layers.0.pigments.0.volume_fraction is missing"));
    EXPECT_THAT(of("pvc_percent = 10\nvolume_fraction = 0.1"), HasSubstr("one concentration"));
    EXPECT_THAT(of("pvc_percent = 80"), HasSubstr("nearest legal value is 74"));
    EXPECT_THAT(of("weight_percent = 50", "binder_density_g_cm3 = 1\n"),
                HasSubstr("r.toml:5:1: layers.0.pigments.0.density_g_cm3 is missing"));
    EXPECT_THAT(of("weight_percent = 50\ndensity_g_cm3 = 4"), HasSubstr("layers.0.binder_density_g_cm3 is missing"));
    EXPECT_THAT(of("weight_percent = 95\ndensity_g_cm3 = 1", "binder_density_g_cm3 = 1\n"),
                HasSubstr("add up to 0.95"));
    EXPECT_THAT(of("number_density_per_um3 = 1000"), HasSubstr("add up to 4.18879"));
    const std::string second = "[[layers.pigments]]\n" + titania;
    const std::string half = "weight_percent = 50\ndensity_g_cm3 = 4\n", binder = "binder_density_g_cm3 = 1\n";
    EXPECT_THAT(of(half + second + half, binder), HasSubstr("weights add up to 100 %"));
    EXPECT_THAT(of(half + second + "volume_fraction = 0.1\n", binder),
                HasSubstr("layers.0.pigments.1.density_g_cm3 is missing"));
}

// Spheres brought as a table of angles scatter like the spheres.
TEST(ExternalPigment, ReproducesTheSpheresItDescribes) {
    const ScratchFolder folder;
    std::ofstream matrix(folder / "spheres_matrix.csv"), cross(folder / "spheres_cross.csv");
    matrix.precision(12), cross.precision(12);
    matrix << "wavelength_nm,angle_deg,F11,F12,F22,F33,F34,F44\n";
    cross << "wavelength_nm,extinction_um2,scattering_um2\n";
    for (const double nm : {500.0, 600.0}) {
        const optics::ScatteringProperties p =
            optics::scatter({2.7, 0.01}, 1.5, nm, {optics::Monodisperse{0.1}}, {.tolerance = 1e-9});
        cross << nm << "," << p.extinction_um2 << "," << p.scattering_um2 << "\n";
        for (int degree = 0; degree <= 180; ++degree) {
            const optics::ScatteringElements f = optics::evaluate(p.expansion, std::cos(radians(degree)));
            matrix << nm << "," << degree;
            for (const double value : {f.a1, f.b1, f.a2, f.a3, f.b2, f.a4}) matrix << "," << 3.7 * value;
            matrix << "\n";
        }
    }
    matrix.close(), cross.close();

    const std::string concentration = "number_density_per_um3 = 5\n";
    const std::string external =
        "matrix = \"spheres_matrix.csv\"\ncross_sections = \"spheres_cross.csv\"\nparticle_volume_um3 = "
        "0.004188790204786391\n";
    const std::string spheres =
        "material = { n = 2.7, k = 0.01 }\nsize = { distribution = \"mono\", radius_um = 0.1 }\n";
    for (const double nm : {500.0, 600.0}) {
        const rt::Layer a =
            optical_problem(parse_recipe(layer(external + concentration), "r", folder), nm).problem.layers[0];
        const rt::Layer b =
            optical_problem(parse_recipe(layer(spheres + concentration), "r", folder), nm, 1e-8).problem.layers[0];
        EXPECT_NEAR(a.optical_thickness, b.optical_thickness, 1e-9 * b.optical_thickness);
        EXPECT_NEAR(a.single_scattering_albedo, b.single_scattering_albedo, 1e-9);
        // Splines through 181 angles leave some 1e-7.
        for (int l = 0; l <= 5; ++l) {
            EXPECT_NEAR(a.expansion.alpha1[l], b.expansion.alpha1[l], 1e-6);
            EXPECT_NEAR(a.expansion.beta1[l], b.expansion.beta1[l], 1e-6);
            EXPECT_NEAR(a.expansion.beta2[l], b.expansion.beta2[l], 1e-6);
            EXPECT_NEAR(a.expansion.alpha4[l], b.expansion.alpha4[l], 1e-6);
        }
    }
    EXPECT_THROW(optical_problem(parse_recipe(layer(external + concentration), "r", folder), 620.0), Error);
    // Dense packing needs no more than the volume.
    EXPECT_NO_THROW(optical_problem(parse_recipe(layer(external + "volume_fraction = 0.3\n"), "r", folder), 550.0));
}

TEST(ExternalPigment, SaysWhatIsWrong) {
    const ScratchFolder folder;
    std::ofstream(folder / "isotropic.csv") << "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2\n0,1,0,0,1,0,0\n";
    const auto of = [&](const std::string& pigment) -> std::string {
        try {
            parse_recipe(layer(pigment + "volume_fraction = 0.1\n"), "r.toml", folder);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    const std::string good =
        "expansion = \"isotropic.csv\"\nextinction_um2 = 0.2\nscattering_um2 = 0.1\nparticle_volume_um3 = 0.01\n";
    EXPECT_EQ(of(good), "");
    EXPECT_THAT(of(good + "material = \"Au\"\n"), HasSubstr("has no meaning here"));
    EXPECT_THAT(of(good + "matrix = \"isotropic.csv\"\n"), HasSubstr("has no meaning here"));
    EXPECT_THAT(of("matrix = \"nowhere.csv\"\nparticle_volume_um3 = 1\n"), HasSubstr("file not found"));
    EXPECT_THAT(of("expansion = \"isotropic.csv\"\nparticle_volume_um3 = 1\n"), HasSubstr("extinction_um2 is missing"));
    EXPECT_THAT(of("expansion = \"isotropic.csv\"\nextinction_um2 = 1\nscattering_um2 = 1\n"),
                HasSubstr("particle_volume_um3 is missing"));
    EXPECT_THAT(of("expansion = \"isotropic.csv\"\nextinction_um2 = 1\nscattering_um2 = 2\nparticle_volume_um3 = 1\n"),
                HasSubstr("exceeds extinction_um2"));
    EXPECT_THAT(of(titania + "particle_volume_um3 = 1\n"), HasSubstr("spheres are computed"));
}

// An optical layer takes a matrix against angle as it takes coefficients: Rayleigh's.
TEST(OpticalLayerMatrix, OfRayleigh) {
    const ScratchFolder folder;
    std::ofstream file(folder / "rayleigh.csv");
    file.precision(12);
    file << "# Rayleigh\nangle_deg, F11, F12, F22, F33, F34, F44\n";
    for (int degree = 0; degree <= 180; ++degree) {
        const double c = std::cos(radians(degree));
        file << degree << "," << 1 + c * c << "," << c * c - 1 << "," << 1 + c * c << "," << 2 * c << ",0," << 2 * c
             << "\n";
    }
    file.close();
    const std::string text =
        "[[layers]]\noptical_thickness = 1\nsingle_scattering_albedo = 0.9\nmatrix = \"rayleigh.csv\"\n";
    const Recipe recipe = parse_recipe(text, "r", folder);
    const optics::ExpansionCoefficients& c = std::get<OpticalLayer>(recipe.layers[0].content).expansion;
    // docs/conventions.md; the spline of 1 degree.
    EXPECT_NEAR(c.alpha1[2], 0.5, 1e-7);
    EXPECT_NEAR(c.alpha2[2], 3.0, 1e-6);
    EXPECT_NEAR(c.alpha4[1], 1.5, 1e-7);
    EXPECT_NEAR(c.beta1[2], std::sqrt(6.0) / 2, 1e-7);
    EXPECT_THROW(parse_recipe(text + "expansion = \"rayleigh.csv\"\n", "r", folder), Error);
}

// 2/3 ordinary and 1/3 extraordinary of everything per particle.
TEST(BirefringentPigment, AveragesItsRays) {
    const std::string text = layer(
        "material_ordinary = { n = 2.6 }\nmaterial_extraordinary = { n = 2.9 }\nvolume_fraction = 0.01\nsize = { "
        "distribution = \"mono\", radius_um = 0.1 }\n");
    const OpticalProblem problem = optical_problem(parse_recipe(text, "r", "."), 550.0);
    const auto one = [](double n) { return optics::scatter(n, 1.5, 550.0, {optics::Monodisperse{0.1}}); };
    const double expected = 10 * 0.01 / one(2.6).mean_volume_um3 *
                            (2.0 / 3.0 * one(2.6).extinction_um2 + 1.0 / 3.0 * one(2.9).extinction_um2);
    EXPECT_NEAR(problem.problem.layers[0].optical_thickness, expected, 1e-12 * expected);
    EXPECT_THAT(problem.notes, ::testing::Contains(HasSubstr("birefringent")));
    EXPECT_THAT(message_of(text, {"layers.0.pigments.0.material=Au"}), HasSubstr("has no meaning here"));
    EXPECT_THAT(message_of(layer("material_ordinary = \"Au\"\nvolume_fraction = 0.1\nsize = { distribution = \"mono\", "
                                 "radius_um = 0.1 }\n")),
                HasSubstr("material_extraordinary is missing"));
}

rt::Layer tinted(double k, double thickness_um, const std::string& pigment = "") {
    const std::string text = "[[layers]]\nthickness_um = " + std::to_string(thickness_um) +
                             "\nbinder = { n = 1.5, k = " + std::to_string(k) + " }\n" + pigment;
    return optical_problem(parse_recipe(text, "r.toml", "."), 500.0).problem.layers[0];
}

// A dyed binder follows Beer and Lambert to the strongest k there is.
TEST(TintedBinder, WithoutPigmentIsBeerLambert) {
    for (const double thickness : {0.5, 5.0, 50.0})
        for (const double k : {0.0001, 0.003, 0.05}) {
            EXPECT_NEAR(tinted(k, thickness).optical_thickness, 4 * pi * k * thickness / 0.5,
                        1e-13 * k * thickness / 0.5 * 4 * pi);
            EXPECT_EQ(tinted(k, thickness).single_scattering_albedo, 0.0);
        }
    EXPECT_THROW(tinted(0.06, 1.0), Error);
}

// Particles of the binder's own n and no k dilute the dye: (1 - f) of its absorption is left. Next order: k (k' r).
TEST(TintedBinder, ClearParticlesDiluteTheDye) {
    const double k = 0.002;
    const rt::Layer layer = tinted(k, 10.0,
                                   "[[layers.pigments]]\nmaterial = { n = 1.5 }\nvolume_fraction = 0.2\nsize = { "
                                   "distribution = \"mono\", radius_um = 0.1 }\n");
    EXPECT_NEAR(layer.optical_thickness / (4 * pi * k * 10.0 / 0.5), 0.8, 0.2 * 10 * k);
}

// Particles from elsewhere keep their cross sections and take the place of the dye: tau = d (a + N (C - a V)).
TEST(TintedBinder, ParticlesFromElsewhereReplaceTheDye) {
    const ScratchFolder folder;
    std::ofstream(folder / "isotropic.csv") << "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2\n0,1,0,0,1,0,0\n";
    const std::string text =
        "[[layers]]\nthickness_um = 10\nbinder = { n = 1.5, k = 0.01 }\n[[layers.pigments]]\nexpansion = "
        "\"isotropic.csv\"\nextinction_um2 = 0.02\nscattering_um2 = 0.02\nparticle_volume_um3 = 0.01\n"
        "number_density_per_um3 = 4\n";
    const rt::Layer layer = optical_problem(parse_recipe(text, "r", folder), 500.0).problem.layers[0];
    const double a = 4 * pi * 0.01 / 0.5;
    EXPECT_NEAR(layer.optical_thickness, 10 * (a + 4 * (0.02 - a * 0.01)), 1e-12);
    EXPECT_NEAR(layer.single_scattering_albedo, 4 * 0.02 / (a + 4 * (0.02 - a * 0.01)), 1e-12);
}

// Tinted enamel: absorption grows with the dye, the albedo stays a probability, and refraction is reported.
TEST(TintedBinder, WithPigmentAbsorbsMoreTheMoreDye) {
    const std::string pigment = "[[layers.pigments]]\n" + titania + "volume_fraction = 0.04\n";
    double last = 1.0 + 1e-12;
    for (const double k : {0.0, 1e-5, 1e-4, 1e-3, 1e-2, 0.05}) {
        const double albedo = tinted(k, 10.0, pigment).single_scattering_albedo;
        EXPECT_LT(albedo, last);
        EXPECT_GT(albedo, 0.0);
        last = albedo;
    }
    const std::string text = "[[layers]]\nthickness_um = 1\nbinder = { n = 1.5, k = 0.01 }\n";
    EXPECT_THAT(optical_problem(parse_recipe(text, "r", "."), 500.0).notes,
                ::testing::Contains(HasSubstr("refracts by n alone")));
}

// Large clear particles in a dark binder: each scatters, seen from its centre, more than reached it.
TEST(TintedBinder, WhereTheTheoryEndsAnErrorSaysSo) {
    EXPECT_THROW(tinted(0.02, 10.0,
                        "[[layers.pigments]]\nmaterial = { n = 1.7 }\nvolume_fraction = 0.5\nsize = { distribution = "
                        "\"mono\", radius_um = 3 }\n"),
                 Error);
}

}  // namespace
}  // namespace patina::coating
