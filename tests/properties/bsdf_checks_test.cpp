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

TEST(BsdfChecks, NameWhatCannotBeBuilt) {
    EXPECT_THROW(check_bsdfs(*scene({node("bsdf", "roughconductr")}), {}), Error);
}

}  // namespace
}  // namespace patina::render::test
