// Ctrl-C within one long solution: every command ends soon, with exit code 130.

#include <chrono>
#include <fstream>

#include "run_patina.h"
#include <gmock/gmock.h>

namespace patina::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* recipe = R"([interface]
type = "rough"
alpha = 0.05
[[layers]]
thickness_um = 300
binder = { n = 1.5 }
[[layers.pigments]]
material = { n = 2.75 }
volume_fraction = 0.1
size = { distribution = "mono", radius_um = 0.3 }
)";

// Each takes a minute and more by itself, in a single solution of one wavelength.
struct LongCommand {
    const char* name;
    const char* arguments;
};
void PrintTo(const LongCommand& command, std::ostream* out) {
    *out << command.name;
}

class Interrupt : public PatinaTest, public ::testing::WithParamInterface<LongCommand> {
  protected:
    struct Stopped {
        int exit_code;
        double seconds;  // from the signal to the end
        std::string err;
    };
    Stopped stop_after(double seconds, const std::string& arguments) const {
        const std::string script =
            "cd '" + folder().string() + "'; '" + PATINA_BINARY + "' " + arguments +
            " >/dev/null 2>err & pid=$!; sleep " + std::to_string(seconds) +
            "; kill -INT $pid; date +%s.%N >begin; wait $pid; code=$?; date +%s.%N >end; exit $code";
        const int status = std::system(script.c_str());
        double begin = 0.0, end = 0.0;
        std::ifstream(folder() / "begin") >> begin;
        std::ifstream(folder() / "end") >> end;
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, end - begin, read_file(folder() / "err")};
    }
};

TEST_P(Interrupt, EndsWithinSeconds) {
    write_file(folder() / "paint.toml", recipe);
    const Stopped stopped = stop_after(0.7, GetParam().arguments);
    EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
    EXPECT_THAT(stopped.err, HasSubstr("stopping; what is done will be kept"));
    EXPECT_THAT(stopped.err, HasSubstr("stopped"));
    // About one doubling of the largest layer, on a machine that does much else.
    EXPECT_LT(stopped.seconds, 3.0);
}

INSTANTIATE_TEST_SUITE_P(
    Commands, Interrupt,
    ::testing::Values(
        LongCommand{"solve", "solve paint.toml -o t.h5 --wavelengths 550 --streams 150"},
        LongCommand{"solve_by_eigenmodes",
                    "solve paint.toml -o t.h5 --wavelengths 550 --streams 60 --solver eigenmodes --set "
                    "'interface={type=\"smooth\"}'"},
        LongCommand{"field",
                    "field paint.toml --theta-i-deg 30 --wavelength-nm 550 --solver montecarlo --samples 1000000000"},
        LongCommand{"sweep",
                    "sweep paint.toml -o s --vary layers.0.thickness_um=300:400:2 --wavelengths 550 --streams 250"},
        LongCommand{"validate", "validate --solver montecarlo"}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace patina::test
