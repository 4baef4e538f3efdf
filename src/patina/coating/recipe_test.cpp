#include "patina/coating/recipe.h"

#include <fstream>

#include "patina/coating/optical_problem.h"
#include "patina/core/constants.h"
#include "patina/core/scratch_folder_for_tests.h"
#include "patina/optics/scattering/particle_ensemble.h"

namespace patina::coating {
namespace {

using ::testing::HasSubstr;

const std::string two_layers = R"(
title = "two coats"
[interface]
type = "smooth"
[[layers]]
thickness_um = 20
binder = { n = 1.5, k = 1e-6 }
[[layers]]
name = "base coat"
thickness_um = 4
binder = { n = 1.45 }
[[layers.pigments]]
material = { n = 2.75 }
volume_fraction = 0.01
size = { distribution = "mono", radius_um = 0.1 }
[base]
type = "lambertian"
reflectance = 0.25
)";

TEST(Recipe, ReadsEveryPart) {
    const Recipe recipe = parse_recipe(two_layers, "r.toml", ".");
    EXPECT_EQ(recipe.title, "two coats");
    EXPECT_TRUE(recipe.has_interface);
    ASSERT_EQ(recipe.layers.size(), 2u);
    EXPECT_EQ(recipe.layers[1].name, "base coat");
    const auto& coat = std::get<Composition>(recipe.layers[1].content);
    EXPECT_EQ(coat.thickness_um, 4.0);
    ASSERT_EQ(coat.pigments.size(), 1u);
    EXPECT_EQ(std::get<optics::Monodisperse>(std::get<Spheres>(coat.pigments[0].particles).size.shape).radius_um, 0.1);
    EXPECT_EQ(std::get<LambertianBase>(recipe.base).reflectance(500.0), 0.25);
}

TEST(Recipe, SettingsReplaceAndAddKeys) {
    const Recipe recipe = parse_recipe(two_layers, "r.toml", ".",
                                       {"layers.1.thickness_um=9", "layers.1.pigments.0.volume_fraction=0.03",
                                        R"(base={ type = "none" })", "title=plain words"});
    EXPECT_EQ(std::get<Composition>(recipe.layers[1].content).thickness_um, 9.0);
    EXPECT_EQ(std::get<Composition>(recipe.layers[1].content).pigments[0].volume_fraction, 0.03);
    EXPECT_TRUE(std::holds_alternative<NoBase>(recipe.base));
    EXPECT_EQ(recipe.title, "plain words");
    EXPECT_THAT(recipe.text, HasSubstr("plain words"));
}

TEST(Recipe, SettingsThatLeadNowhereAreUsageErrors) {
    for (const char* setting : {"layers.7.thickness_um=1", "nothing", "layers.x.thickness_um=1", "layers=", "=3"})
        EXPECT_THROW(parse_recipe(two_layers, "r.toml", ".", {setting}), Error) << setting;
}

TEST(Recipe, ErrorsNameLineColumnReasonAndNearestValue) {
    try {
        parse_recipe("[[layers]]\nthickness_um = 10\nbinder = { n = -1 }\n", "r.toml", ".");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_THAT(error.what(), HasSubstr("r.toml:3:"));
        EXPECT_THAT(error.what(), HasSubstr("layers.0.binder.n = -1 is out of range"));
        EXPECT_THAT(error.what(), HasSubstr("nearest legal value is 0.001"));
    }
}

// Beer-Lambert: a clear binder's optical thickness is 4 pi k d / lambda.
TEST(OpticalProblem, ClearLayerAbsorbsByBeerLambert) {
    const rt::Problem problem = optical_problem(parse_recipe(two_layers, "r.toml", "."), 500.0).problem;
    EXPECT_NEAR(problem.layers[0].optical_thickness, 4 * pi * 1e-6 * 20 / 0.5, 1e-15);
    EXPECT_EQ(problem.layers[0].single_scattering_albedo, 0.0);
    EXPECT_EQ(problem.layers[0].refractive_index, 1.5);
    EXPECT_EQ(problem.refractive_index_above, 1.0);
    EXPECT_EQ(std::get<rt::LambertianBase>(problem.base).reflectance, 0.25);
}

// tau = d f C_ext / V; transparent particles in a transparent binder scatter conservatively.
TEST(OpticalProblem, OpticalThicknessIsNumberDensityTimesCrossSectionTimesDepth) {
    const rt::Layer coat = optical_problem(parse_recipe(two_layers, "r.toml", "."), 500.0).problem.layers[1];
    const optics::ScatteringProperties one = optics::scatter(2.75, 1.45, 500.0, {optics::Monodisperse{0.1}});
    EXPECT_NEAR(coat.optical_thickness, 4.0 * 0.01 * one.extinction_um2 / (4.0 / 3.0 * pi * 1e-3), 1e-12);
    EXPECT_NEAR(coat.single_scattering_albedo, 1.0, 1e-14);
}

TEST(OpticalProblem, AnIndexMatchedTopHasTheIndexOfTheFirstLayerAbove) {
    const rt::Problem problem =
        optical_problem(parse_recipe(two_layers, "r.toml", ".", {R"(base={ type = "none" })"}), 500.0).problem;
    const Recipe without = parse_recipe(two_layers.substr(two_layers.find("[[layers]]")), "r.toml", ".");
    EXPECT_EQ(optical_problem(without, 500.0).problem.refractive_index_above, 1.5);
    EXPECT_TRUE(std::holds_alternative<rt::BlackBase>(problem.base));
}

TEST(OpticalProblem, DensePackingIsReportedAndReducesScattering) {
    const auto at = [](const char* packing) {
        return optical_problem(
            parse_recipe(two_layers, "r.toml", ".",
                         {"layers.1.pigments.0.volume_fraction=0.2", std::string("layers.1.packing=") + packing}),
            550.0);
    };
    EXPECT_TRUE(at("independent").notes.empty());
    ASSERT_EQ(at("auto").notes.size(), 1u);
    EXPECT_THAT(at("auto").notes[0], HasSubstr("Percus-Yevick"));
    EXPECT_LT(at("auto").problem.layers[1].optical_thickness,
              0.9 * at("independent").problem.layers[1].optical_thickness);
}

TEST(OpticalProblem, ExtrapolationIsRefusedUnlessAskedForAndThenFlagged) {
    const std::string text = R"([[layers]]
thickness_um = 1
binder = { n = 1.5 }
[[layers.pigments]]
material = "TiO2-rutile"
volume_fraction = 0.01
size = { distribution = "mono", radius_um = 0.1 }
)";
    EXPECT_THROW(optical_problem(parse_recipe(text, "r.toml", "."), 400.0), Error);
    const OpticalProblem held =
        optical_problem(parse_recipe("extrapolation = \"hold\"\n" + text, "r.toml", "."), 400.0);
    EXPECT_THAT(held.notes, ::testing::Contains(HasSubstr("held outside")));
}

TEST(Recipe, ReadsARoughTop) {
    const std::string layer = "[[layers]]\nthickness_um = 10\nbinder = { n = 1.5 }\n";
    const auto problem = [&](const std::string& top) {
        return optical_problem(parse_recipe("[interface]\n" + top + layer, "r.toml", "."), 550.0).problem;
    };
    EXPECT_EQ(problem("type = \"rough\"\nalpha = 0.1\n").top_roughness->alpha, 0.1);
    EXPECT_EQ(problem("type = \"rough\"\nalpha = 0.1\ndistribution = \"beckmann\"\n").top_roughness->distribution,
              rt::FacetDistribution::beckmann);
    EXPECT_FALSE(problem("type = \"smooth\"\n").top_roughness);
    for (const char* wrong :
         {"type = \"rough\"\n", "type = \"rough\"\nalpha = 0.01\n", "type = \"smooth\"\nalpha = 0.1\n"})
        EXPECT_THROW(problem(wrong), Error) << wrong;
}

TEST(Recipe, ReadsARoughMetal) {
    const Recipe recipe = parse_recipe(
        "[[layers]]\nthickness_um = 10\nbinder = { n = 1.5 }\n"
        "[base]\ntype = \"metal\"\nmaterial = { n = 1, k = 6 }\nalpha = 0.3\ndistribution = \"beckmann\"\n",
        "r.toml", ".");
    const rt::Problem problem = optical_problem(recipe, 550.0).problem;
    EXPECT_EQ(std::get<rt::MetalBase>(problem.base).roughness->alpha, 0.3);
    EXPECT_EQ(std::get<rt::MetalBase>(problem.base).roughness->distribution, rt::FacetDistribution::beckmann);
}

TEST(Recipe, RoughSurfacesThatCannotBeAreErrors) {
    const auto message = [](const std::string& tables) -> std::string {
        try {
            parse_recipe("[[layers]]\nthickness_um = 10\nbinder = { n = 1.5 }\n" + tables, "r.toml", ".");
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    const std::string metal = "[base]\ntype = \"metal\"\nmaterial = { n = 1, k = 6 }\n";
    EXPECT_THAT(message(metal + "alpha = 0.01"), HasSubstr("0.04"));
    EXPECT_THAT(message(metal + "distribution = \"ggx\""), HasSubstr("mirror"));
    EXPECT_THAT(message("[interface]\ntype = \"rough\""), HasSubstr("rough"));
}

// A coating on another recipe is the coating with all the layers.
TEST(Recipe, LiesOnAnotherRecipe) {
    const ScratchFolder folder;
    std::ofstream(folder / "below.toml") << two_layers;
    std::ofstream(folder / "self.toml")
        << "[[layers]]\nthickness_um = 10\nbinder = { n = 1.5 }\n[base]\ntype = \"recipe\"\nrecipe = \"self.toml\"\n";
    const std::string top =
        "[interface]\ntype = \"smooth\"\n[[layers]]\nthickness_um = 10\nbinder = { n = 1.6 }\n[base]\ntype = "
        "\"recipe\"\nrecipe = \"below.toml\"\n";
    const Recipe recipe = parse_recipe(top, "r.toml", folder);
    ASSERT_EQ(recipe.layers.size(), 3u);
    EXPECT_EQ(std::get<LambertianBase>(recipe.base).reflectance(500.0), 0.25);
    const rt::Problem problem = optical_problem(recipe, 550.0).problem;
    EXPECT_EQ(problem.layers[0].refractive_index, 1.6);
    EXPECT_EQ(problem.layers[2].refractive_index, 1.45);
    EXPECT_NO_THROW(parse_recipe(recipe.text, "again", folder));
    EXPECT_THROW(read_recipe(folder / "self.toml"), Error);
    EXPECT_THROW(parse_recipe(top, "r.toml", folder / "nowhere"), Error);
}

// A file name that no file can have is that of a missing file.
TEST(Recipe, FileNamesMayBeTooLong) {
    const std::string name(5000, 'a'), layer = "[[layers]]\noptical_thickness = 1\nsingle_scattering_albedo = 1\n";
    const std::string whole = layer + "expansion = \"examples/data/siewert_problem_IIA.csv\"\n";
    for (const std::string& text :
         {layer + "expansion = \"" + name + "\"\n",
          whole + "[base]\ntype = \"lambertian\"\nreflectance = \"" + name + "\"\n",
          whole + "[base]\ntype = \"recipe\"\nrecipe = \"" + name + "\"\n",
          whole + "[base]\ntype = \"table\"\nrefractive_index = 1.5\nfile = \"" + name + "\"\n"})
        try {
            parse_recipe(text, "paint.toml", PATINA_SOURCE_DIR);
            ADD_FAILURE() << text.substr(0, 200);
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), ::testing::HasSubstr("file not found"));
        }
}

}  // namespace
}  // namespace patina::coating
