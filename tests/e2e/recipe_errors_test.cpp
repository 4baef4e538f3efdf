// Every kind of bad recipe ends with exit code 3, the place, and a reason; none is a crash, a hang or a number.

#include "run_patina.h"
#include <gmock/gmock.h>

namespace patina::test {
namespace {

using ::testing::HasSubstr;

struct BadRecipe {
    const char* name;
    const char* text;
    const char* message;  // part of what must be said
};

void PrintTo(const BadRecipe& recipe, std::ostream* os) {
    *os << recipe.name;
}

const std::string good_layer = R"([[layers]]
thickness_um = 10
binder = "acrylic"
[[layers.pigments]]
material = "TiO2-rutile"
volume_fraction = 0.02
size = { distribution = "mono", radius_um = 0.1 }
)";

class BadRecipes : public PatinaTest, public ::testing::WithParamInterface<BadRecipe> {};

TEST_P(BadRecipes, AreRefusedWithAReason) {
    write_file(folder() / "bad.toml", GetParam().text);
    const Outcome outcome = patina("solve bad.toml -o out.h5 --wavelengths 550", 60);
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(GetParam().message));
    EXPECT_THAT(outcome.err, HasSubstr("bad.toml"));
    EXPECT_FALSE(fs::exists(folder() / "out.h5"));
}

const BadRecipe bad_recipes[] = {
    {"Empty", "", "needs at least one [[layers]]"},
    {"NotToml", "this is = = not toml", "bad.toml:1:"},
    {"Truncated", "[[layers]]\nthickness_um = 1\nbinder = { n = 1.5,", "bad.toml:3"},
    {"UnknownKey", "[[layers]]\nthicknes_um = 10\n", "did you mean \"thickness_um\"?"},
    {"UnknownTable", "[interfaces]\ntype = \"smooth\"\n", "did you mean \"interface\"?"},
    {"MissingThickness", "[[layers]]\nbinder = \"acrylic\"\n", "layers.0.thickness_um is missing"},
    {"NegativeThickness", "[[layers]]\nthickness_um = -1\nbinder = \"acrylic\"\n",
     "bad.toml:2:16: layers.0.thickness_um = -1 is out of range"},
    {"NanThickness", "[[layers]]\nthickness_um = nan\nbinder = \"acrylic\"\n", "out of range"},
    {"InfiniteThickness", "[[layers]]\nthickness_um = inf\nbinder = \"acrylic\"\n", "out of range"},
    {"ThicknessIsText", "[[layers]]\nthickness_um = \"ten\"\nbinder = \"acrylic\"\n",
     "must be a number (it is a string)"},
    {"LayersIsNumber", "layers = 3\n", "must be a array of tables"},
    {"UnknownBinder", "[[layers]]\nthickness_um = 1\nbinder = \"acryllic\"\n", "did you mean \"acrylic\"?"},
    {"NegativeK", "[[layers]]\nthickness_um = 1\nbinder = { n = 1.5, k = -0.1 }\n", "k = -0.1 is out of range"},
    {"BinderFileMissing", "[[layers]]\nthickness_um = 1\nbinder = \"nowhere.yml\"\n", "nowhere.yml"},
    {"FractionAboveClosestPacking",
     "[[layers]]\nthickness_um = 1\nbinder = \"acrylic\"\n[[layers.pigments]]\nmaterial = \"Au\"\nvolume_fraction = "
     "0.8\nsize = { distribution = \"mono\", radius_um = 0.1 }\n",
     "the nearest legal value is 0.74"},
    {"FractionsAddUpToTooMuch",
     "[[layers]]\nthickness_um = 1\nbinder = \"acrylic\"\n[[layers.pigments]]\nmaterial = \"Au\"\nvolume_fraction = "
     "0.4\nsize = { distribution = \"mono\", "
     "radius_um = 0.1 }\n[[layers.pigments]]\nmaterial = \"Ag\"\nvolume_fraction = 0.4\nsize = { distribution = "
     "\"mono\", radius_um = 0.1 }\n",
     "add up to 0.8"},
    {"UnknownDistribution",
     "[[layers]]\nthickness_um = 1\nbinder = \"acrylic\"\n[[layers.pigments]]\nmaterial = \"Au\"\nvolume_fraction = "
     "0.1\nsize = { distribution = \"lognormall\", "
     "radius_um = 0.1 }\n",
     "did you mean \"lognormal\"?"},
    {"KeyOfAnotherDistribution",
     "[[layers]]\nthickness_um = 1\nbinder = \"acrylic\"\n[[layers.pigments]]\nmaterial = \"Au\"\nvolume_fraction = "
     "0.1\nsize = { distribution = \"mono\", "
     "radius_um = 0.1, sigma_g = 1.3 }\n",
     "belongs to distribution = \"lognormal\""},
    {"SigmaOne",
     "[[layers]]\nthickness_um = 1\nbinder = \"acrylic\"\n[[layers.pigments]]\nmaterial = \"Au\"\nvolume_fraction = "
     "0.1\nsize = { distribution = \"lognormal\", "
     "median_radius_um = 0.1, sigma_g = 1.0 }\n",
     "must be above 1"},
    {"AlbedoAboveOne", "[[layers]]\noptical_thickness = 1\nsingle_scattering_albedo = 1.1\nexpansion = \"x.csv\"\n",
     "the nearest legal value is 1"},
    {"CoefficientsMissing",
     "[[layers]]\noptical_thickness = 1\nsingle_scattering_albedo = 0.9\nexpansion = \"nowhere.csv\"\n", "nowhere.csv"},
    {"MixedLayer",
     "[[layers]]\noptical_thickness = 1\nsingle_scattering_albedo = 0.9\nexpansion = \"x.csv\"\nthickness_um = 3\n",
     "has no meaning here"},
    {"UnknownBase", "[[layers]]\nthickness_um = 1\nbinder = \"acrylic\"\n[base]\ntype = \"mirror\"\n",
     "base.type = \"mirror\" is not known"},
    {"ReflectanceAboveOne",
     "[[layers]]\nthickness_um = 1\nbinder = \"acrylic\"\n[base]\ntype = \"lambertian\"\nreflectance = 2\n",
     "the nearest legal value is 1"},
    {"MetalWithoutMaterial", "[[layers]]\nthickness_um = 1\nbinder = \"acrylic\"\n[base]\ntype = \"metal\"\n",
     "base.material is missing"},
    {"ReflectanceOfMetal",
     "[[layers]]\nthickness_um = 1\nbinder = \"acrylic\"\n[base]\ntype = \"metal\"\nmaterial = \"Al\"\nreflectance = "
     "0.5\n",
     "has no meaning here"},
};

INSTANTIATE_TEST_SUITE_P(Recipes, BadRecipes, ::testing::ValuesIn(bad_recipes),
                         [](const auto& param) { return param.param.name; });

class CoefficientFiles : public PatinaTest {
  protected:
    Outcome field_with(const std::string& coefficients, const std::string& options = "") {
        write_file(folder() / "c.csv", coefficients);
        write_file(folder() / "r.toml",
                   "[[layers]]\noptical_thickness = 1\nsingle_scattering_albedo = 0.9\nexpansion = \"c.csv\"\n");
        return patina("field r.toml --theta-i-deg 30 " + options, 60);
    }
};

TEST_F(CoefficientFiles, BrokenOnesAreRefusedWithLineAndColumn) {
    const std::string header = "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2\n";
    const std::pair<std::string, std::string> cases[] = {
        {"", "no coefficients"},
        {"0,1,0,0,1,0,0\n", "c.csv:1:1: the header line is missing"},
        {header + "0,1,0,0\n", "c.csv:2:"},
        {header + "0,1,0,0,nan,0,0\n", "c.csv:2:9: \"nan\" is not a finite number"},
        {header + "0,1,0,0,x,0,0\n", "c.csv:2:9: \"x\" is not a finite number"},
        {header + "1,1,0,0,1,0,0\n", "l = 1 where l = 0 is expected"},
        {header + "0,0.5,0,0,1,0,0\n", "alpha1 of l = 0 is 0.5"},
        {header + "0,1,0,0,1,0,0\n1,3.5,0,0,1,0,0\n", "at most 2l+1 = 3"},
    };
    for (const auto& [text, message] : cases) {
        const Outcome outcome = field_with(text);
        EXPECT_EQ(outcome.exit_code, 3) << text << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(message)) << text;
    }
}

// Rayleigh's coefficients with beta1 in the column of alpha2: numbers that look right and are none of any matter.
TEST_F(CoefficientFiles, MistakenColumnsAreRefusedAndCutOffSeriesAreReported) {
    const std::string header = "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2\n";
    const Outcome mistaken = field_with(header + "0,1,0,0,0,0,0\n1,0,0,0,1.5,0,0\n2,0.5,1.2247,0,0,3,0\n");
    EXPECT_EQ(mistaken.exit_code, 3);
    EXPECT_THAT(mistaken.err, HasSubstr("c.csv:2:1: scattered by 90 degrees"));

    const Outcome slightly = field_with(header + "0,1,0,0,0,0,0\n1,0,0,0,1.5,0,0\n2,0.5,3,0,0,1.3,0\n");
    EXPECT_EQ(slightly.exit_code, 0);
    EXPECT_THAT(slightly.err, HasSubstr("more polarization than intensity (by 0.092"));  // 1.5 (1.3 / 1.2247 - 1)

    const Outcome exact = field_with(header + "0,1,0,0,0,0,0\n1,0,0,0,1.5,0,0\n2,0.5,3,0,0,1.2247449,0\n");
    EXPECT_EQ(exact.exit_code, 0);
    EXPECT_EQ(exact.err, "");
}

// Henyey and Greenstein's g = 0.95 at 8 streams: f = g^16 = 0.44 counts as unscattered, and the user is told.
TEST_F(CoefficientFiles, AForwardPeakCutOffIsReported) {
    std::string text = "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2\n";
    for (int l = 0; l <= 200; ++l) text += fmt::format("{},{},0,0,0,0,0\n", l, (2 * l + 1) * std::pow(0.95, l));
    const Outcome outcome = field_with(text, "--scalar --streams 8 --json");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.out, HasSubstr("layer 0: 0.44 of its scattering, the forward peak"));
}

class CommandLine : public PatinaTest {
  protected:
    // A quick field with its stdout led elsewhere than to a file.
    Outcome field_into(const std::string& options, const std::string& stdout_to) const {
        const std::string command = fmt::format(
            "cd '{}' && timeout 60 '{}' field '{}' --theta-i-deg 30 --streams 8 {} "
            "2>.stderr {}",
            folder().string(), PATINA_BINARY, example("siewert_problem_IIA.toml").string(), options, stdout_to);
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, "", read_file(folder() / ".stderr")};
    }
};

TEST_F(CommandLine, SuggestsTheNearestCommand) {
    const Outcome outcome = patina("slove x.toml");
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("did you mean \"solve\"?"));
}

TEST_F(CommandLine, HelpAndVersionSucceed) {
    EXPECT_EQ(patina("--help").exit_code, 0);
    EXPECT_EQ(patina("--version").exit_code, 0);
    EXPECT_EQ(patina("solve --help").exit_code, 0);
    EXPECT_EQ(patina("").exit_code, 2);
}

TEST_F(CommandLine, UnwritableOutputIsARuntimeErrorAndLeavesNothing) {
    const Outcome outcome = patina("solve " + example("siewert_problem_IIA.toml").string() + " -o nowhere/out.h5");
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("nowhere"));
}

TEST_F(CommandLine, NamesThatAreTooLongForAFileAreRefused) {
    const std::string name(1000, 'a');
    for (const std::string& command :
         {"new paint " + name, "solve " + example("siewert_problem_IIA.toml").string() + " --resume -o " + name + ".h5",
          "render " + example("polar_balls.xml").string() + " --size 8x8 --spp 1 -o " + name + ".exr"}) {
        const Outcome outcome = patina(command);
        EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
        EXPECT_EQ(outcome.err.find("defect"), std::string::npos) << outcome.err;
    }
}

// A result shorter than the buffer is lost only when that is sent, at the very end.
TEST_F(CommandLine, AResultThatAFullDiskDoesNotTakeIsARuntimeError) {
    for (const char* angles : {"--theta-o-deg 0 --phi-deg 0", "--phi-deg 0:350:1"}) {
        const Outcome outcome = field_into(angles, "> /dev/full");
        EXPECT_EQ(outcome.exit_code, 1) << angles;
        EXPECT_EQ(outcome.err, "error: the standard output cannot be written (No space left on device)\n");
    }
}

TEST_F(CommandLine, AReaderThatGoesAwayEndsItQuietly) {
    const Outcome outcome = field_into("--phi-deg 0:350:1", "| head -1 > first_line");
    EXPECT_EQ(outcome.err, "");
    EXPECT_THAT(read_file(folder() / "first_line"), HasSubstr("theta"));
}

TEST_F(CommandLine, SettingsReachTheRecipe) {
    const Outcome outcome = patina("field " + example("tio2_on_aluminium.toml").string() +
                                       " --theta-i-deg 30 --wavelength-nm 550 --set layers.0.thickness_um=-3",
                                   60);
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("thickness_um = -3 is out of range"));
}

}  // namespace
}  // namespace patina::test
