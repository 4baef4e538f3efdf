// The single scattering of a recipe, as files that recipes read.

#include <cmath>

#include "run_patina.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patina::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* paint = R"([[layers]]
thickness_um = 6
binder = { n = 1.5 }
packing = "independent"
[[layers.pigments]]
material = { n = 2.7, k = 0.01 }
volume_fraction = 0.1
size = { distribution = "lognormal", median_radius_um = 0.12, sigma_g = 1.3 }
[base]
type = "lambertian"
reflectance = 0.3
)";

class Scattering : public PatinaTest {
  protected:
    json scattering(const std::string& arguments) const {
        const Outcome outcome = patina("scattering " + arguments + " --json");
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return json::parse(outcome.out);
    }
    json radiance(const std::string& recipe) const {
        const Outcome outcome = patina("field " + recipe +
                                       " --theta-i-deg 40 --theta-o-deg 0,30,70 --stokes 1,0.5,0.3,0.2 --streams 12 "
                                       "--json");
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return json::parse(outcome.out).at("radiance");
    }
    // The paint's layer in optical terms, its law from a file.
    std::string in_optical_terms(const json& layer, const std::string& law) const {
        return "[[layers]]\noptical_thickness = " + layer["optical_thickness"].dump() +
               "\nsingle_scattering_albedo = " + layer["single_scattering_albedo"].dump() +
               "\nrefractive_index = 1.5\n" + law + "\n[base]\ntype = \"lambertian\"\nreflectance = 0.3\n";
    }
    void expect_same(const json& a, const json& b, double tolerance) const {
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i)
            for (int s = 0; s < 4; ++s)
                EXPECT_NEAR(a[i]["stokes"][s].get<double>(), b[i]["stokes"][s].get<double>(), tolerance) << i << s;
    }
};

TEST_F(Scattering, FilesGiveTheLayerBack) {
    write_file(folder() / "paint.toml", paint);
    const json layer =
        scattering("paint.toml --wavelength-nm 500 -o law.csv --matrix matrix.csv --angles 0:180:0.5")["layers"][0];
    write_file(folder() / "from_law.toml", in_optical_terms(layer, "expansion = \"law.csv\""));
    write_file(folder() / "from_matrix.toml", in_optical_terms(layer, "matrix = \"matrix.csv\""));
    const Outcome direct = patina(
        "field paint.toml --wavelength-nm 500 --theta-i-deg 40 --theta-o-deg 0,30,70 --stokes 1,0.5,0.3,0.2 --streams "
        "12 --json");
    ASSERT_EQ(direct.exit_code, 0) << direct.err;
    const json exact = json::parse(direct.out).at("radiance");
    // The same averages but for the field's own tolerance, 1e-6.
    expect_same(exact, radiance("from_law.toml"), 1e-6);
    // Splines between angles of half a degree.
    expect_same(exact, radiance("from_matrix.toml"), 2e-6);
}

TEST_F(Scattering, NumbersBelongTogether) {
    write_file(folder() / "paint.toml", paint);
    const json layer = scattering("paint.toml --wavelength-nm 500")["layers"][0], &pigment = layer["pigments"][0];
    const double extinction = pigment["extinction_um2"], scattered = pigment["scattering_um2"];
    EXPECT_NEAR(pigment["number_density_per_um3"].get<double>() * pigment["mean_volume_um3"].get<double>(), 0.1, 1e-12);
    EXPECT_NEAR(layer["optical_thickness"].get<double>(),
                6 * pigment["number_density_per_um3"].get<double>() * extinction, 1e-9);
    EXPECT_NEAR(layer["single_scattering_albedo"].get<double>(), scattered / extinction, 1e-12);
    EXPECT_NEAR(extinction, scattered + pigment["absorption_um2"].get<double>(), 1e-12);
    // <r^3>/<r^2> of a log-normal law by number.
    EXPECT_NEAR(pigment["effective_radius_um"].get<double>(), 0.12 * std::exp(2.5 * std::pow(std::log(1.3), 2)), 1e-6);
}

TEST_F(Scattering, SaysWhatIsMissing) {
    write_file(folder() / "paint.toml", paint);
    const Outcome layer = patina("scattering paint.toml --wavelength-nm 500 --layer 2");
    EXPECT_EQ(layer.exit_code, 2);
    EXPECT_THAT(layer.err, HasSubstr("--layer 2"));
    EXPECT_EQ(patina("scattering " + example("white_wall_paint.toml").string()).exit_code, 2);
}

}  // namespace
}  // namespace patina::test
