// A stock Mitsuba 3 scene with filters and the `stokes` integrator: rendered as it is, with Mitsuba's channels and
// signs.

#include "run_patina.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patina::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class MitsubaStokes : public PatinaTest {
  protected:
    static std::string scene() {
        return (fs::path(PATINA_SOURCE_DIR) / "tests" / "data" / "polarizers_stokes.xml").string();
    }
    // Mean Stokes vector over a window of the upper half, where the lamp shines through the filter.
    std::vector<double> seen_through(const std::string& filter, double theta_deg) const {
        const Outcome outcome =
            patina("render " + scene() + " -o f.exr --no-png --spp 4 --crop 4,2,28,12 -D filter=" + filter +
                   " -D theta=" + std::to_string(theta_deg));
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return json::parse(patina("image info f.exr --json").out).at("mean");
    }
};

TEST_F(MitsubaStokes, RendersUnmodifiedWithMitsubasChannels) {
    const Outcome outcome = patina("render " + scene() + " -o m.exr --no-png");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    // The header lists them in the alphabetic order of the format.
    const std::string file = read_file(folder() / "m.exr");
    std::size_t at = 0;
    for (const char* name :
         {"S0.B", "S0.G", "S0.R", "S1.B", "S1.G", "S1.R", "S2.B", "S2.G", "S2.R", "S3.B", "S3.G", "S3.R"}) {
        const std::size_t found = file.find(name, at);
        ASSERT_NE(found, std::string::npos) << name;
        at = found;
    }
    // Without the stokes integrator they are written when asked for.
    ASSERT_EQ(patina("render " + scene() + " -o p.exr --no-png --integrator path --spp 1").exit_code, 0);
    EXPECT_EQ(read_file(folder() / "p.exr").find("S1.R"), std::string::npos);
}

// Through a polarization camera's sensor and back: a polarizer's light stays polarized along its axis.
TEST_F(MitsubaStokes, ACamerasFrameGivesThePolarizationBack) {
    ASSERT_EQ(patina("render " + scene() + " -o f.exr --no-png --spp 4 --crop 4,2,28,12 -D theta=45").exit_code, 0);
    ASSERT_EQ(patina("image mosaic f.exr -o frame.exr --bits 12 --seed 2").exit_code, 0);
    const Outcome back = patina("image demosaic frame.exr -o back.exr");
    ASSERT_EQ(back.exit_code, 0) << back.err;
    const json mean = json::parse(patina("image info back.exr --json").out).at("mean");
    // As below, and the noise of 24 x 10 pixels with some thousand electrons each: below 1 %.
    EXPECT_NEAR(mean[2].get<double>() / mean[0].get<double>(), 1, 0.04);
    EXPECT_NEAR(mean[1].get<double>() / mean[0].get<double>(), 0, 0.04);
    EXPECT_EQ(patina("image error back.exr f.exr -o e.png").exit_code, 0);
    EXPECT_EQ(patina("image noise f.exr -o n.png").exit_code, 0);
}

// Half of the light, polarized along the axis: S1 > 0 horizontal, S2 > 0 at +45 degrees as the camera sees it, and the
// circular polarizer's right-handed light has S3 > 0 (Mitsuba 3, key topic "polarization").
TEST_F(MitsubaStokes, ComponentsHaveMitsubasSigns) {
    struct Case {
        const char* filter;
        double theta_deg;
        double stokes[3];  // over S0
    };
    const Case cases[] = {{"polarizer", 0, {1, 0, 0}},    {"polarizer", 45, {0, 1, 0}}, {"polarizer", 90, {-1, 0, 0}},
                          {"polarizer", 135, {0, -1, 0}}, {"circular", 0, {0, 0, 1}},   {"retarder", 30, {0, 0, 0}}};
    double whole = 0;
    for (const Case& c : cases)
        if (std::string(c.filter) == "retarder") whole = seen_through(c.filter, c.theta_deg)[0];
    EXPECT_GT(whole, 0.5);
    for (const Case& c : cases) {
        const std::vector<double> s = seen_through(c.filter, c.theta_deg);
        // Rays through the filter at up to 15 degrees turn its axis against the camera's by less than 0.02; their mean
        // over both sides of the picture by less. Light that the still life returns is polarized by the filter too.
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(s[k + 1] / s[0], c.stokes[k], 0.03) << c.filter << " " << c.theta_deg;
        if (std::string(c.filter) != "retarder") {
            EXPECT_NEAR(s[0] / whole, 0.5, 0.02) << c.filter;
        }
    }
}

}  // namespace
}  // namespace patina::test
