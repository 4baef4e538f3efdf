#include "patina/core/error.h"

namespace patina {
namespace {

const std::vector<std::string> names = {"CaCO3", "TiO2-rutile", "roughconductor", "Au"};

TEST(DidYouMean, FindsSlipsAndBeginnings) {
    EXPECT_EQ(did_you_mean("TiO2-rutil", names), "did you mean \"TiO2-rutile\"?");
    EXPECT_EQ(did_you_mean("CaCO3-calcite", names), "did you mean \"CaCO3\"?");
    EXPECT_EQ(did_you_mean("rough", names), "did you mean \"roughconductor\"?");
}

TEST(DidYouMean, GuessesNothingFromWhatSharesNothing) {
    EXPECT_EQ(did_you_mean("Aurum-and-more", names), "known: CaCO3, TiO2-rutile, roughconductor, Au");
    EXPECT_EQ(did_you_mean(std::string(1'000'000, 'C'), names, false), "");
    EXPECT_EQ(did_you_mean("anything", {}), "");
}

}  // namespace
}  // namespace patina
