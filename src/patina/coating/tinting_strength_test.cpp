#include "patina/coating/tinting_strength.h"

#include "patina/core/error.h"

namespace patina::coating {
namespace {

// A white with a dye in its binder.
Recipe dyed_white(double k, double fraction = 0.2) {
    const std::string text =
        "[interface]\ntype = \"smooth\"\n[[layers]]\nthickness_um = 30\nbinder = { n = 1.5, k = " + std::to_string(k) +
        " }\n[[layers.pigments]]\nmaterial = { n = 2.7 }\nvolume_fraction = " + std::to_string(fraction) +
        "\nsize = { distribution = \"mono\", radius_um = 0.1 }\n";
    return parse_recipe(text, "white.toml", ".");
}

TintingStrength compare(const Recipe& paint, const Recipe& standard) {
    return tinting_strength(paint, standard, {.wavelengths_nm = {550.0}, .streams = 16});
}

TEST(TintingStrength, OfAPaintAgainstItselfIsOne) {
    const TintingStrength same = compare(dyed_white(1e-4), dyed_white(1e-4));
    EXPECT_DOUBLE_EQ(same.at_maximum, 1.0);
    EXPECT_DOUBLE_EQ(same.integrated, 1.0);
    EXPECT_DOUBLE_EQ(same.delta_e_2000, 0.0);
}

// Duncan's (1940) additivity: absorption, and so K/S of a reduction with white, goes with the amount of the colour.
// Kubelka and Munk's theory and transport theory differ in the next order of the absorption.
TEST(TintingStrength, GoesWithTheAmountOfTheColour) {
    const TintingStrength twice = compare(dyed_white(2e-5), dyed_white(1e-5));
    EXPECT_NEAR(twice.at_maximum, 2.0, 0.02);
    EXPECT_GT(twice.delta_e_2000, 0.1);
    // Twice the white in the same dye halves it.
    const TintingStrength whiter = compare(dyed_white(1e-5, 0.02), dyed_white(1e-5, 0.01));
    EXPECT_NEAR(whiter.at_maximum, 0.5, 0.02);
}

TEST(TintingStrength, NeedsColour) {
    EXPECT_THROW(compare(dyed_white(1e-5), dyed_white(0.0)), Error);
    const Recipe clear = parse_recipe("[[layers]]\nthickness_um = 30\nbinder = { n = 1.5, k = 1e-4 }\n", "c.toml", ".");
    EXPECT_THROW(compare(clear, dyed_white(1e-5)), Error);
}

}  // namespace
}  // namespace patina::coating
