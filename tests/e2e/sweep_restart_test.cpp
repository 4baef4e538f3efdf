// `patina sweep`: what is done stays done, whatever happens to the program.

#include <algorithm>
#include <map>

#include "run_patina.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patina::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string recipe = R"([interface]
type = "smooth"
[[layers]]
thickness_um = 10
binder = { n = 1.5 }
[[layers.pigments]]
material = { n = 2.75 }
volume_fraction = 0.15
size = { distribution = "mono", radius_um = 0.1 }
)";

const std::string command =
    "sweep paint.toml --vary layers.0.thickness_um=1:100:40log -o out --wavelengths 550 --streams 14";

class SweepRestart : public PatinaTest {
  protected:
    SweepRestart() { write_file(folder() / "paint.toml", recipe); }

    std::map<std::string, fs::file_time_type> points() const {
        std::map<std::string, fs::file_time_type> found;
        for (const auto& entry : fs::directory_iterator(folder() / "out/points"))
            if (entry.path().extension() == ".json") found[entry.path().filename()] = entry.last_write_time();
        return found;
    }

    // Runs the sweep until it has finished some points, then sends it a signal; returns its exit code as a shell sees
    // it.
    int start_and_stop(const std::string& signal) const {
        const std::string script = "cd '" + folder().string() + "'; '" + PATINA_BINARY + "' " + command +
                                   " >/dev/null 2>&1 & pid=$!; for i in $(seq 6000); do "
                                   "n=$(ls out/points 2>/dev/null | grep -c json); "
                                   "if [ \"$n\" -ge 3 ]; then break; fi; sleep 0.01; done; "
                                   "kill -" +
                                   signal + " $pid; wait $pid";
        const int status = std::system(("cd '" + folder().string() + "' && " + script).c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
};

TEST_F(SweepRestart, AKilledSweepGoesOnWithoutComputingAgain) {
    ASSERT_EQ(start_and_stop("KILL"), 128 + 9);
    const auto before = points();
    ASSERT_GE(before.size(), 3u);
    ASSERT_LT(before.size(), 40u);
    EXPECT_FALSE(fs::exists(folder() / "out/sweep.csv"));

    const Outcome outcome = patina(command + " --json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json document = json::parse(outcome.out);
    EXPECT_EQ(document.at("points"), 40);
    EXPECT_EQ(document.at("reused"), before.size());
    EXPECT_EQ(document.at("computed"), 40 - before.size());
    const auto after = points();
    EXPECT_EQ(after.size(), 40u);
    for (const auto& [name, time] : before) EXPECT_EQ(after.at(name), time) << name;

    const std::string csv = read_file(folder() / "out/sweep.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 41);
    EXPECT_THAT(csv, HasSubstr("layers.0.thickness_um,contrast_ratio,hiding_power_m2_per_l"));
    EXPECT_THAT(read_file(folder() / "out/sweep.h5"), HasSubstr("HDF"));
}

TEST_F(SweepRestart, CtrlCKeepsWhatIsDone) {
    EXPECT_EQ(start_and_stop("INT"), 130);
    const std::size_t done = points().size();
    ASSERT_GE(done, 3u);
    ASSERT_LT(done, 40u);
    const Outcome outcome = patina(command + " --json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(json::parse(outcome.out).at("reused"), done);
}

TEST_F(SweepRestart, PointsOfAnotherRecipeAreNotUsed) {
    const std::string small = "sweep paint.toml --vary layers.0.thickness_um=1:3:2 -o out --wavelengths 550 --json";
    ASSERT_EQ(patina(small).exit_code, 0);
    const Outcome outcome = patina(small + " --set layers.0.pigments.0.volume_fraction=0.1");
    ASSERT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(json::parse(outcome.out).at("computed"), 2);
    EXPECT_THAT(outcome.err, HasSubstr("belong to another recipe"));
}

TEST_F(SweepRestart, BadGridsAreUsageErrors) {
    for (const char* vary : {"", " --vary layers.0.thickness_um", " --vary layers.0.thickness_um=1:2",
                             " --vary layers.0.thickness_um=1:2:x", " --vary layers.0.thickness_um=0:2:3log",
                             " --vary layers.5.thickness_um=1:2:3",
                             " --vary layers.0.thickness_um=1:2:3 --vary layers.0.thickness_um=1:2:3"})
        EXPECT_EQ(patina("sweep paint.toml -o out" + std::string(vary), 60).exit_code, 2) << vary;
    EXPECT_EQ(patina("sweep paint.toml -o out --vary layers.0.thickness_um=-5:5:3", 60).exit_code, 3);
    EXPECT_FALSE(fs::exists(folder() / "out"));
}

// The crowding of white paint: each particle scatters less the more there are, until the film scatters less by more
// pigment. Percus-Yevick puts the best concentration of particles of r = 0.1 um near a third of the film.
TEST_F(SweepRestart, WhitePaintScattersMostNearAThird) {
    const Outcome outcome =
        patina("sweep " + example("white_wall_paint.toml").string() +
               " --vary layers.0.pigments.0.volume_fraction=0.02:0.5:17 -o out --wavelengths 550 --json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json document = json::parse(outcome.out);
    const auto columns = document.at("columns").get<std::vector<std::string>>();
    const std::size_t s = std::find(columns.begin(), columns.end(), "kubelka_munk_s_per_um") - columns.begin();
    const auto fractions = document.at("axes")[0].at("values").get<std::vector<double>>();
    std::size_t best = 0;
    double previous_efficiency = 1e9;
    for (std::size_t p = 0; p < fractions.size(); ++p) {
        const double power = document.at("values")[p][s];
        if (power > document.at("values")[best][s].get<double>()) best = p;
        // Up to 0.05 particles count as independent, and two fluxes wander by a thousandth.
        EXPECT_LT(power / fractions[p], previous_efficiency * 1.005) << fractions[p];
        previous_efficiency = power / fractions[p];
    }
    EXPECT_NEAR(fractions[best], 1.0 / 3.0, 0.05);
}

}  // namespace
}  // namespace patina::test
