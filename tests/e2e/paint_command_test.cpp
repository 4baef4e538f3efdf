// The command `patina paint`, and `patina compare`, as users meet them.

#include "run_patina.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patina::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class PaintCommand : public PatinaTest {
  protected:
    static std::string wall() { return example("white_wall_paint.toml").string(); }
};

TEST_F(PaintCommand, WhiteWallPaintHasAContrastRatioAndAHidingPower) {
    const Outcome outcome = patina("paint " + wall());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const char* part : {"contrast ratio", "hiding power", "m2/l", "45:0", "d:8", "D65", "whiteness", "gloss",
                             "Kubelka-Munk", "45as15"})
        EXPECT_THAT(outcome.out, HasSubstr(part));
}

TEST_F(PaintCommand, JsonIsOneDocumentWithEveryQuantity) {
    const Outcome outcome =
        patina("paint " + wall() + " --json --wavelengths 440:680:60 --set volume_solids=0.4 --target 95,0,2");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json document = json::parse(outcome.out);
    EXPECT_EQ(document.at("schema"), "patina/paint/1");
    EXPECT_GT(document.at("contrast_ratio"), 0.9);
    EXPECT_LT(document.at("contrast_ratio"), 1.0);
    EXPECT_GT(document.at("hiding_power_m2_per_l"), 1.0);
    EXPECT_NEAR(document.at("hiding_power_m2_per_l").get<double>() * document.at("hiding_thickness_um").get<double>(),
                400.0, 1e-9);
    EXPECT_EQ(document.at("colours").size(), 4u * 3u * 6u);
    EXPECT_EQ(document.at("film").size(), 5u);
    EXPECT_EQ(document.at("aspecular").size(), 5u);
    EXPECT_EQ(document.at("gloss").size(), 3u);
    EXPECT_GT(document.at("target").at("delta_e_2000"), 0.0);
    EXPECT_NEAR(document.at("film")[0].at("saunderson_k2"), 0.596, 0.01);
}

TEST_F(PaintCommand, BadOptionsAreUsageErrors) {
    for (const char* options : {" --target 1,2", " --target x", " --white 2", " --contrast-ratio 1", " --streams 1",
                                " --wavelengths 500,400", " --set nothing"})
        EXPECT_EQ(patina("paint " + wall() + " --quick" + options, 60).exit_code, 2) << options;
    EXPECT_EQ(patina("paint nowhere.toml").exit_code, 3);
    EXPECT_EQ(patina("paint " + wall() + " --set volume_solids=0", 60).exit_code, 3);
    EXPECT_EQ(patina("paint " + wall() + " --target nowhere.h5", 60).exit_code, 3);
}

// A table of the recipe has the recipe's colour.
TEST_F(PaintCommand, ATableOfTheRecipeIsOnTarget) {
    ASSERT_EQ(patina("solve " + wall() + " -o wall.h5 --wavelengths 450,550,650 --streams 16").exit_code, 0);
    const Outcome outcome =
        patina("paint " + wall() + " --quick --json --wavelengths 450,550,650 --streams 16 --target wall.h5");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    // The same nodes; sizes averaged to tolerances a factor ten apart, which no eye sees: a thousandth of a just
    // noticeable difference.
    EXPECT_LT(json::parse(outcome.out).at("target").at("delta_e_2000"), 1e-3);
    const Outcome same = patina("compare wall.h5 wall.h5 --json");
    ASSERT_EQ(same.exit_code, 0) << same.err;
    EXPECT_EQ(json::parse(same.out).at("wavelengths")[0].at("f00").at("max"), 0.0);
}

TEST_F(PaintCommand, RecipesCompareByColour) {
    std::string text = read_file(example("white_wall_paint.toml"));
    write_file(folder() / "a.toml", text);
    write_file(folder() / "b.toml", text.replace(text.find("thickness_um = 40"), 17, "thickness_um = 10"));
    const Outcome outcome = patina("compare a.toml b.toml --json --wavelengths 450,550,650");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json document = json::parse(outcome.out);
    EXPECT_GT(document.at("colours")[0].at("delta_e_2000"), 0.5);
    EXPECT_LT(document.at("contrast_ratio")[1], document.at("contrast_ratio")[0]);
    EXPECT_EQ(patina("compare a.toml b.h5").exit_code, 2);
}

// Twice the white in a dyed binder halves K/S.
TEST_F(PaintCommand, ComparesTintingStrengths) {
    const std::string enamel = example("tinted_enamel.toml").string();
    const Outcome outcome = patina("paint " + enamel + " --set layers.0.pigments.0.weight_percent=10 --against " +
                                   enamel + " --quick --json --wavelengths 450,550 --streams 12");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json strength = json::parse(outcome.out).at("tinting_strength");
    EXPECT_EQ(strength.at("wavelength_nm"), 450.0);
    // The extender scatters a part of it, and twice the weight of pigment is a little more than twice the volume.
    EXPECT_NEAR(strength.at("at_maximum"), 0.5, 0.05);
    EXPECT_EQ(patina("paint " + enamel + " --against nowhere.toml --quick", 60).exit_code, 3);
}

}  // namespace
}  // namespace patina::test
