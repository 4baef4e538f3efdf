// The checks a user can run on models: they pass lawful ones, and find what they are for.

#include "patina/render/bsdf_checks.h"

#include <gtest/gtest.h>

#include "patina/core/bitmap.h"
#include "patina/core/error.h"
#include "patina/render/test_support.h"

namespace patina::render::test {
namespace {

TEST(BsdfChecks, PassModelsThatObeyTheLawsAndFindOneThatIsNotReciprocal) {
    SceneResources resources;
    resources.load_bitmap = [](const std::string&, bool) {
        return std::make_shared<const Bitmap>(Bitmap{"tilted", 1, 1, {"R", "G", "B"}, {0.67f, 0.5f, 0.97f}});
    };
    const Node map = node("bsdf", "normalmap", {},
                          {node("bsdf", "diffuse"), node("texture", "bitmap", {{"filename", std::string("tilted")}})});
    map->children[1].name = "normalmap";
    const Node gold = node("bsdf", "roughconductor", {{"alpha", 0.3}});
    gold->id = "gold";
    // One model inside a shape, one referred to twice.
    const auto reports =
        check_bsdfs(*scene({gold, node("shape", "sphere", {}, {gold}), node("shape", "sphere", {}, {map})}), resources);
    ASSERT_EQ(reports.size(), 3u);
    EXPECT_EQ(reports[0].id, "gold");
    EXPECT_TRUE(reports[0].passed());
    EXPECT_EQ(reports[1].type, "normalmap");
    EXPECT_FALSE(reports[1].passed());
    for (const BsdfCheck& check : reports[1].checks)
        EXPECT_EQ(check.passed(), check.name != "reciprocity") << check.name;
    EXPECT_EQ(reports[2].type, "diffuse");
    EXPECT_TRUE(reports[2].passed());
}

// The ends of what parameters may be: lobes so sharp that single precision sees them barely, a body whose surface lets
// one part in 10^4 of its light out, indices below that of vacuum, facets as rough as they get,
// and surfaces whose light is polarized this way or that from draw to draw.
TEST(BsdfChecks, PassModelsAtTheEndsOfTheirParameters) {
    const std::vector<Node> models = {
        node("bsdf", "phong", {{"exponent", 1e6}}),
        node("bsdf", "lafortune", {{"exponent_1", 1e6}, {"lobe_1", Eigen::Vector3d(-1, 1, 1)}}),
        node("bsdf", "lafortune", {{"exponent_1", 1e6}, {"lobe_1", Eigen::Vector3d(1e20, 1e20, 1e20)}}),
        node("bsdf", "plastic", {{"int_ior", 10.0}, {"ext_ior", 0.1}}),
        node("bsdf", "roughplastic", {{"int_ior", 10.0}, {"ext_ior", 0.1}, {"alpha", 1e-4}}),
        node("bsdf", "pplastic", {{"int_ior", 0.5}, {"alpha", 2.0}}),
        node("bsdf", "dipole", {{"int_ior", 10.0}, {"ext_ior", 0.1}}),
        node("bsdf", "thindielectric", {{"int_ior", 10.0}, {"ext_ior", 0.1}}),
        node("bsdf", "roughdielectric", {{"int_ior", 1.0 + 1e-7}, {"ext_ior", 1.0}}),
        node("bsdf", "roughdielectric", {{"int_ior", 2.5}}),
        node("bsdf", "roughdielectric", {{"int_ior", 0.5}, {"ext_ior", 1.0}}),
        node("bsdf", "conductor", {uniform("eta", 1e6), uniform("k", 1e6)}),
        node("bsdf", "roughconductor", {uniform("eta", 0), uniform("k", 0), {"alpha", 2.0}}),
    };
    for (const Node& model : models)
        for (const BsdfReport& report : check_bsdfs(*scene({model}), {}))
            for (const BsdfCheck& check : report.checks)
                EXPECT_TRUE(check.passed()) << report.type << ", " << check.name << ": " << check.worst;
}

TEST(BsdfChecks, NameWhatCannotBeBuilt) {
    EXPECT_THROW(check_bsdfs(*scene({node("bsdf", "roughconductr")}), {}), Error);
    // Numbers that are no index of anything, and whose powers single precision does not hold.
    EXPECT_THROW(check_bsdfs(*scene({node("bsdf", "dielectric", {{"int_ior", 100.0}})}), {}), Error);
    EXPECT_THROW(check_bsdfs(*scene({node("bsdf", "conductor", {uniform("eta", 1e10), uniform("k", 1e10)})}), {}),
                 Error);
}

}  // namespace
}  // namespace patina::render::test
