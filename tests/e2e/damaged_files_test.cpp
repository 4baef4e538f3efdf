// Damaged files through the whole program: exit code 3 (or 4 for a check that fails) and a reason, whatever they hold.
// tests/fuzz has the many; these are of every kind of file.

#include "run_patina.h"
#include <gmock/gmock.h>

namespace patina::test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

class DamagedFiles : public PatinaTest {
  protected:
    void expect_refused(const std::string& arguments, const std::string& reason) const {
        const Outcome outcome = patina(arguments, 60);
        EXPECT_THAT(outcome.exit_code, AnyOf(3, 4)) << arguments << "\n" << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(reason)) << arguments;
        EXPECT_THAT(outcome.err, Not(HasSubstr("defect of patina"))) << arguments;
        EXPECT_LT(outcome.err.size(), 10000u) << arguments;
    }
    std::string layer(const std::string& pigment) const {
        return "[[layers]]\nthickness_um = 1\nbinder = { n = 1.5 }\n[[layers.pigments]]\nvolume_fraction = 0.1\n" +
               pigment;
    }
};

TEST_F(DamagedFiles, Recipes) {
    const std::string solve = "solve r.toml -o t.h5 --wavelengths 550";
    const std::pair<std::string, const char*> recipes[] = {
        {std::string(1'000'000, 'x'), "not TOML"},
        {"title = \"" + std::string(1'000'000, 'x') + "\"\nlayer = 3\n", "unknown key \"layer\""},
        {std::string(1'000'000, 'x') + " = 1\n", "unknown key"},
        {"layers = " + std::string(100'000, '['), "not TOML"},
        {std::string("\x89PNG\r\n\0\0\xff\xfe", 10), "r.toml:1:"},
        {"[[layers]]\nthickness_um = 1\nthickness_um = 2\nbinder = \"acrylic\"\n", "r.toml:3:"},
        {"[[layers]]\nthickness_um = 1e308\nbinder = \"acrylic\"\n", "nearest legal value"},
        {layer("material = 7\nsize = { distribution = \"mono\", radius_um = 0.1 }\n"), "must be a material"},
        {layer("material = \"Au\"\nsize = { distribution = \"mono\", radius_um = 900 }\n"), "radii"},
    };
    for (const auto& [text, reason] : recipes) {
        write_file(folder() / "r.toml", text);
        expect_refused(solve, reason);
        EXPECT_FALSE(fs::exists(folder() / "t.h5"));
    }
}

TEST_F(DamagedFiles, OpticalConstantsAndScatteringFiles) {
    write_file(folder() / "m.yml",
               "DATA:\n  - type: formula 2\n    wavelength_range: 0.4 0.7\n    coefficients: 0 -9 0\n");
    write_file(folder() / "deep.yml", std::string(100'000, '['));
    write_file(folder() / "m.csv", "wavelength_nm,n,k\n500,1.5,nan\n");
    write_file(folder() / "f.csv", "angle_deg,F11,F12,F22,F33,F34,F44\n0,1,0,1,1,0,1\n180,1,2,1,1,0,1\n");
    write_file(folder() / "l.csv", "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2\n0,1,0,0,1e99,0,0\n");
    const std::string size = "size = { distribution = \"mono\", radius_um = 0.1 }\n",
                      cross = "extinction_um2 = 1\nscattering_um2 = 1\nparticle_volume_um3 = 1\n";
    const std::pair<std::string, const char*> pigments[] = {
        {"material = \"m.yml\"\n" + size, "no positive index"}, {"material = \"deep.yml\"\n" + size, "deep.yml"},
        {"material = \"m.csv\"\n" + size, "m.csv:2:9"},         {"matrix = \"f.csv\"\n" + cross, "f.csv:2"},
        {"expansion = \"l.csv\"\n" + cross, "l.csv:2"},         {"matrix = \".\"\n" + cross, "not a regular file"},
    };
    for (const auto& [pigment, reason] : pigments) {
        write_file(folder() / "r.toml", layer(pigment));
        expect_refused("inspect r.toml", reason);
    }
    expect_refused("materials show m.csv", "m.csv:2:9");
}

TEST_F(DamagedFiles, Tables) {
    ASSERT_EQ(patina("solve " + example("siewert_problem_IIA.toml").string() + " -o good.h5 --streams 4").exit_code, 0);
    const std::string good = read_file(folder() / "good.h5");
    std::string flipped = good;
    flipped[good.size() / 2] ^= 1;
    write_file(folder() / "flipped.h5", flipped);
    write_file(folder() / "short.h5", good.substr(0, good.size() / 2));
    write_file(folder() / "text.h5", "no table\n");
    write_file(folder() / "t.pbsdf", std::string("tensor_file\0\1\0\xff\xff\xff\xff", 18));
    for (const char* command : {"inspect", "check"}) {
        expect_refused(std::string(command) + " flipped.h5", "damaged");
        expect_refused(std::string(command) + " short.h5", "short.h5");
        expect_refused(std::string(command) + " text.h5", "text.h5");
    }
    expect_refused("convert flipped.h5 out.csv", "damaged");
    expect_refused("convert t.pbsdf out.h5", "truncated");
    EXPECT_FALSE(fs::exists(folder() / "out.h5"));
}

}  // namespace
}  // namespace patina::test
