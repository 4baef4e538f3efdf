#include "patina/jobs/field.h"

#include "patina/coating/recipe.h"

namespace patina::jobs {
namespace {

// Spheres of calcite's index whose phase function has more than 128 terms, index matched over black.
const std::string coarse = R"(
[[layers]]
thickness_um = 20
binder = { n = 1.5 }
[[layers.pigments]]
material = { n = 1.62 }
volume_fraction = 0.04
size = { distribution = "lognormal", median_radius_um = 1.75, sigma_g = 1.1 }
)";

// Sharp phase functions are truncated at few nodes; all that they ask for show the same to the fifth digit.
TEST(FieldJob, FewNodesAreEnoughForSharpPhaseFunctions) {
    const coating::Recipe recipe = coating::parse_recipe(coarse, "coarse.toml", ".");
    FieldJob job;
    job.theta_i_deg = 40.0;
    job.theta_o_deg = {0.0, 35.0, 70.0};
    job.phi_deg = {0.0, 70.0, 180.0};
    job.wavelength_nm = 550.0;
    job.scalar = true;  // a fiftieth of the time, and the forward peak is that of the intensity
    const FieldResult chosen = field(recipe, job);
    EXPECT_LT(chosen.diagnostics.streams, 72);
    job.streams = 80;
    const FieldResult all = field(recipe, job);

    ASSERT_EQ(chosen.radiance.size(), all.radiance.size());
    double largest = 0.0;
    for (const FieldValue& value : all.radiance) largest = std::max(largest, value.stokes[0]);
    for (std::size_t i = 0; i < all.radiance.size(); ++i)
        EXPECT_LT((chosen.radiance[i].stokes - all.radiance[i].stokes).cwiseAbs().maxCoeff(), 5e-6 * largest)
            << (all.radiance[i].upward ? "up " : "down ") << all.radiance[i].theta_deg << ", "
            << all.radiance[i].phi_deg;
}

}  // namespace
}  // namespace patina::jobs
