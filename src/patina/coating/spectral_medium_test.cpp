#include "patina/coating/spectral_medium.h"

#include <gtest/gtest.h>

#include "patina/coating/optical_problem.h"
#include "patina/core/error.h"

namespace patina::coating {
namespace {

Recipe two_layers() {
    return parse_recipe(R"(
[[layers]]
thickness_um = 7
binder = { n = 1.4 }
[[layers]]
thickness_um = 30
binder = { n = 1.5, k = 1e-5 }
[[layers.pigments]]
material = { n = 2.7 }
volume_fraction = 0.1
size = { distribution = "mono", radius_um = 0.1 }
)",
                        "paint.toml", ".");
}

// A length of the medium that is the layer's thickness is the layer.
TEST(SpectralMedium, ThicknessTimesExtinctionIsTheOpticalThickness) {
    const Recipe recipe = two_layers();
    const optics::SpectralMedium medium = spectral_medium(recipe, -1, 500, 50, 3);  // the topmost that scatters: 1
    ASSERT_EQ(medium.media.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        const rt::Layer layer = optical_problem(recipe, 500 + 50.0 * static_cast<double>(i)).problem.layers[1];
        const optics::ScatteringMedium& at = medium.media[i];
        EXPECT_NEAR(at.extinction_per_um * 30, layer.optical_thickness, 1e-12 * layer.optical_thickness);
        EXPECT_NEAR(at.albedo(), layer.single_scattering_albedo, 1e-12);
        EXPECT_NEAR(at.absorption_per_um + at.scattering_per_um, at.extinction_per_um, 1e-15);
        EXPECT_EQ(at.expansion.alpha1, layer.expansion.alpha1);
        EXPECT_EQ(medium.host_index[i], 1.5);
    }
    EXPECT_EQ(spectral_medium(recipe, 0, 500, 50, 1).media[0].extinction_per_um, 0);
}

TEST(SpectralMedium, RefusesLayersThatAreNotThereOrHaveNoLength) {
    EXPECT_THROW(spectral_medium(two_layers(), 2, 500, 50, 1), Error);
    Recipe recipe = two_layers();
    std::get<Composition>(recipe.layers[1].content).thickness_um = 0;
    EXPECT_THROW(spectral_medium(recipe, 1, 500, 50, 1), Error);
    recipe.layers[1].content = OpticalLayer{1.0, 0.9, {{1}, {0}, {0}, {0}, {0}, {0}}, 1.5};
    EXPECT_THROW(spectral_medium(recipe, 1, 500, 50, 1), Error);
}

}  // namespace
}  // namespace patina::coating
