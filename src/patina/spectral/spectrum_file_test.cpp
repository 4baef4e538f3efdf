#include "patina/spectral/spectrum_file.h"

#include <random>

#include "patina/core/error.h"

namespace patina::spectral {
namespace {

using ::testing::HasSubstr;

TEST(SpectrumFile, ReadsSpdAndCsv) {
    const Spectrum spd = parse_spectrum("# lamp\n400 1\n 500\t3 # peak\r\n\n600 +2e0", "a.spd", Outside::zero);
    EXPECT_DOUBLE_EQ(spd(450), 2.0);
    EXPECT_DOUBLE_EQ(spd(650), 0.0);
    const Spectrum csv = parse_spectrum("wavelength_um,reflectance\n0.4,0.1\n0.6,0.3\n", "a.csv", Outside::hold);
    EXPECT_NEAR(csv(500), 0.2, 1e-15);
    EXPECT_DOUBLE_EQ(csv(700), 0.3);
    EXPECT_DOUBLE_EQ(parse_spectrum("500,1", "a.csv", Outside::hold)(100), 1.0);
    EXPECT_DOUBLE_EQ(parse_spectrum("500; 1\n600;2", "a.csv", Outside::hold)(550), 1.5);
}

TEST(SpectrumFile, ErrorsNameThePlace) {
    const std::pair<const char*, const char*> cases[] = {
        {"", "a.spd: no spectrum"},
        {"# only words\n", "a.spd: no spectrum"},
        {"wavelength_nm,value\n", "a.spd: no rows below the header"},
        {"lambda,value\n400,1\n", "a.spd:1:1: \"lambda\" is no wavelength"},
        {"400 1\n500\n", "a.spd:2:1: 1 cells in a row"},
        {"400 1\n500 1 2\n", "a.spd:2:1: 3 cells in a row"},
        {"400 1\n500 x\n", "a.spd:2:5: \"x\" is not a finite number"},
        {"400 1\n500,\n", "a.spd:2:5: \"\" is not a finite number"},
        {"400 1\n500 nan\n", "a.spd:2:5: \"nan\" is not a finite number"},
        {"400 1\n400 2\n", "a.spd:2:1: wavelength 400 stands twice"},
        {"400 1\n300 2\n", "a.spd:2:1: wavelength 300 follows 400"},
        {"-400 1\n", "a.spd:1:1: wavelength -400"},
    };
    for (const auto& [text, expected] : cases) {
        try {
            parse_spectrum(text, "a.spd", Outside::zero);
            ADD_FAILURE() << "accepted: " << text;
        } catch (const Error& error) {
            EXPECT_THAT(std::string(error.what()), HasSubstr(expected));
        }
    }
    EXPECT_THROW(read_spectrum("no/such/file.spd", Outside::zero), Error);
}

// Random bytes give a spectrum or an Error, never another exception.
TEST(SpectrumFile, SurvivesNoise) {
    std::mt19937 random(3);
    const std::string alphabet = "0123456789.-e ,\n\t#\r\xff";
    for (int trial = 0; trial < 3000; ++trial) {
        std::string text;
        for (unsigned length = random() % 40; length > 0; --length) text += alphabet[random() % alphabet.size()];
        try {
            EXPECT_TRUE(std::isfinite(parse_spectrum(text, "a", Outside::hold)(500.0))) << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
        }
    }
}

}  // namespace
}  // namespace patina::spectral
