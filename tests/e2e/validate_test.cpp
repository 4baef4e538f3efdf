// `patina validate` and `patina convert` as a user meets them.

#include "run_patina.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patina::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Validate : public PatinaTest {};

TEST_F(Validate, EveryBenchmarkPassesAndIsWrittenDown) {
    const Outcome outcome = patina("validate --json --html page.html --markdown page.md", 600);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
    const json report = json::parse(outcome.out);
    EXPECT_EQ(report["schema"], "patina/validate/1");
    EXPECT_TRUE(report["passed"]);
    EXPECT_GE(report["cases"].size(), 30u);

    // Each case says what was compared, with what and how far off; every solver did Siewert's problem.
    int siewert = 0;
    for (const json& one : report["cases"]) {
        if (!one["skipped"].is_null()) continue;
        EXPECT_GT(one["values"], 0) << one;
        EXPECT_LE(one["largest_error_in_tolerances"], 1.0) << one;
        EXPECT_FALSE(one["source"].get<std::string>().empty());
        siewert += one["case"] == "Siewert IIA";
        if (one["case"] == "Siewert IIA") {
            // Eight tables of 22 cosines at seven depths; the Monte Carlo cannot see the two horizontal rows.
            EXPECT_EQ(one["values"], 8 * (one["solver"] == "montecarlo" ? 20 : 22) * 7);
        }
    }
    EXPECT_GE(siewert, 2);

    // Ignoring polarization errs by 0.2 to 0.4 % here, polarized transfer by less than the digits printed.
    double vector = 0.0, scalar = 0.0;
    for (const json& row : report["cost_of_ignoring_polarization"]) {
        const double published = row["published"];
        vector = std::max(vector, std::abs(row["vector"].get<double>() / published - 1));
        scalar = std::max(scalar, std::abs(row["scalar"].get<double>() / published - 1));
    }
    EXPECT_LT(vector, 1e-5);
    EXPECT_GT(scalar, 2e-3);

    const std::string page = read_file(folder() / "page.html"), markdown = read_file(folder() / "page.md");
    EXPECT_THAT(page, HasSubstr("Siewert (2000)"));
    EXPECT_THAT(page, Not(HasSubstr("http")));  // self-contained
    EXPECT_THAT(markdown, HasSubstr("| Siewert IIA | doubling |"));
}

TEST_F(Validate, UnknownSolverIsAUsageError) {
    const Outcome outcome = patina("validate --solver doublin", 60);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("did you mean \"doubling\"?"));
}

class Convert : public PatinaTest {
  protected:
    void SetUp() override {
        ASSERT_EQ(patina("solve '" + example("tio2_on_aluminium.toml").string() +
                         "' -o a.h5 --wavelengths 450,500,550,600,650")
                      .exit_code,
                  0);
    }
    json convert(const std::string& arguments) {
        const Outcome outcome = patina("convert --json " + arguments);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return outcome.exit_code == 0 ? json::parse(outcome.out) : json();
    }
};

// Linear interpolation on steps h errs by h^2 f''/8 an axis: the BRDF of paint under an interface falls from its
// plateau to 0 at grazing within some 10 deg.
TEST_F(Convert, PbsdfRoundTripStatesItsInterpolationError) {
    const json fine = convert("a.h5 a.pbsdf");
    EXPECT_EQ(fine["wavelengths_nm"], json({450, 500, 550, 600, 650}));
    const double largest_value = fine["error"]["largest_value"];
    EXPECT_LT(fine["error"]["rms"].get<double>(), 2e-3 * largest_value);
    EXPECT_LT(fine["error"]["largest"].get<double>(), 2e-2 * largest_value);

    // Half the steps, a quarter of the error: the error stated is the grid's.
    const json coarse = convert("a.h5 b.pbsdf --grid 37x23x32");
    EXPECT_GT(coarse["error"]["rms"].get<double>(), 2.0 * fine["error"]["rms"].get<double>());
}

TEST_F(Convert, PbsdfComesBackAsTableAndCsv) {
    convert("a.h5 a.pbsdf --grid 37x23x32");
    const json back = convert("a.pbsdf back.h5");
    EXPECT_LT(back["error"]["rms"].get<double>(), 1e-2 * back["error"]["largest_value"].get<double>());
    EXPECT_EQ(patina("check back.h5").exit_code & ~4, 0);  // readable; what a grid breaks of physics it may break
    convert("a.pbsdf a.csv");
    EXPECT_THAT(read_file(folder() / "a.csv"),
                ::testing::StartsWith("wavelength_nm,theta_i_deg,theta_o_deg,phi_deg,m00"));
}

TEST_F(Convert, MerlHasItsSize) {
    convert("a.h5 a.binary");
    EXPECT_EQ(fs::file_size(folder() / "a.binary"), 12u + 3u * 8u * 90u * 90u * 180u);
}

TEST_F(Convert, CsvTakesWavelengthsBetweenTheTables) {
    const json report = convert("a.h5 a.csv --wavelengths 475,525");
    EXPECT_EQ(report["wavelengths_nm"], json({475, 525}));
}

TEST_F(Convert, RefusesWhatMakesNoSense) {
    const std::pair<const char*, const char*> cases[] = {
        {"a.h5 a.xyz", "unknown format"},
        {"a.h5 a.pbsdf --grid 10x10", "three numbers"},
        {"a.h5 a.csv --grid 10x10x10", "--grid sets the grid of a .pbsdf"},
        {"a.h5 a.csv --wavelengths 300", "outside the table"},
        {"a.binary a.csv", "no spectrum"},
    };
    for (const auto& [arguments, message] : cases) {
        const Outcome outcome = patina(std::string("convert ") + arguments);
        EXPECT_EQ(outcome.exit_code, 2) << arguments << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(message)) << arguments;
    }
    write_file(folder() / "broken.pbsdf", "tensor_file");
    EXPECT_EQ(patina("convert broken.pbsdf a.csv").exit_code, 3);
}

}  // namespace
}  // namespace patina::test
