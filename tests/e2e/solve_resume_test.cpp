// `patina solve --resume`: finished wavelengths survive the death of the program, and the result has the same bits.

#include "run_patina.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "patina/io/table_hdf5.h"

namespace patina::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* recipe = R"([interface]
type = "smooth"
[[layers]]
thickness_um = 10
binder = { n = 1.5 }
[[layers.pigments]]
material = { n = 2.75 }
volume_fraction = 0.15
size = { distribution = "mono", radius_um = 0.1 }
)";

const std::string command = "solve paint.toml -o out.h5 --wavelengths 400:690:10 --streams 14";

class SolveResume : public PatinaTest {
  protected:
    SolveResume() { write_file(folder() / "paint.toml", recipe); }

    fs::path checkpoint() const { return folder() / "out.h5.checkpoint"; }

    // Runs the command until it has kept three wavelengths of 0.4 MB and more, then sends it a signal; returns its exit
    // code as a shell sees it.
    int start_and_stop(const std::string& signal) const {
        const std::string script = "cd '" + folder().string() + "'; '" + PATINA_BINARY + "' " + command +
                                   " >/dev/null 2>&1 & pid=$!; for i in $(seq 6000); do "
                                   "n=$(stat -c %s out.h5.checkpoint 2>/dev/null || echo 0); "
                                   "if [ \"$n\" -ge 1500000 ]; then break; fi; sleep 0.01; done; "
                                   "kill -" +
                                   signal + " $pid; wait $pid";
        const int status = std::system(script.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    void expect_the_bits_of_an_uninterrupted_run() {
        const brdf::MuellerTable resumed = io::read_table_hdf5(folder() / "out.h5");
        ASSERT_EQ(patina(command).exit_code, 0);
        const brdf::MuellerTable whole = io::read_table_hdf5(folder() / "out.h5");
        ASSERT_EQ(resumed.wavelengths_nm, whole.wavelengths_nm);
        EXPECT_EQ(resumed.error_estimate, whole.error_estimate);
        for (std::size_t w = 0; w < whole.body.size(); ++w) {
            ASSERT_EQ(resumed.body[w].modes.size(), whole.body[w].modes.size());
            for (std::size_t m = 0; m < whole.body[w].modes.size(); ++m)
                EXPECT_EQ(resumed.body[w].modes[m], whole.body[w].modes[m]) << w << " " << m;
        }
    }
};

TEST_F(SolveResume, AKilledSolveGoesOnWithTheSameBits) {
    ASSERT_EQ(start_and_stop("KILL"), 128 + 9);
    ASSERT_TRUE(fs::exists(checkpoint()));
    EXPECT_FALSE(fs::exists(folder() / "out.h5"));

    // A record cut short by the kill, as a full disk or a lost page would leave it, is dropped.
    const auto size = fs::file_size(checkpoint());
    fs::resize_file(checkpoint(), size - 1000);
    const Outcome outcome = patina(command + " --resume --json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_GE(json::parse(outcome.out).at("resumed"), 2);
    EXPECT_FALSE(fs::exists(checkpoint()));
    expect_the_bits_of_an_uninterrupted_run();
}

TEST_F(SolveResume, CtrlCKeepsWhatIsDone) {
    EXPECT_EQ(start_and_stop("INT"), 130);
    const std::size_t done = io::read_table_hdf5(folder() / "out.h5").wavelengths_nm.size();
    ASSERT_LT(done, 30u);
    const Outcome outcome = patina(command + " --resume --json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_GE(json::parse(outcome.out).at("resumed"), done);
    EXPECT_EQ(json::parse(outcome.out).at("plan").at("wavelengths_nm").size(), 30u);
}

TEST_F(SolveResume, RefusesTheCheckpointOfAnotherJob) {
    ASSERT_EQ(start_and_stop("KILL"), 128 + 9);
    const Outcome tolerance = patina(command + " --resume --tolerance 1e-2");
    EXPECT_EQ(tolerance.exit_code, 3);
    EXPECT_THAT(tolerance.err, HasSubstr("its tolerance is 0.001, here 0.01"));
    const Outcome changed = patina(command + " --resume --set layers.0.thickness_um=11");
    EXPECT_EQ(changed.exit_code, 3);
    EXPECT_THAT(changed.err, HasSubstr("its recipe is another"));

    write_file(checkpoint(), "not a checkpoint\n");
    const Outcome foreign = patina(command + " --resume");
    EXPECT_EQ(foreign.exit_code, 3);
    EXPECT_THAT(foreign.err, HasSubstr("not a checkpoint of this program"));
}

}  // namespace
}  // namespace patina::test
