#include "patina/optics/optical_constants_file.h"

#include <fstream>
#include <random>

#include "patina/core/error.h"
#include "patina/core/scratch_folder_for_tests.h"
#include "patina/optics/dispersion_formula.h"
#include "patina/optics/materials.h"

namespace patina::optics {
namespace {

using ::testing::HasSubstr;
using Complex = std::complex<double>;

OpticalConstants yaml(const std::string& text) {
    return parse_optical_constants_yaml(text, "a.yml", "a").constants;
}
OpticalConstants csv(const std::string& text) {
    return parse_optical_constants_csv(text, "a.csv", "a").constants;
}

template <class Read>
std::string message_of(Read read, const std::string& text) {
    try {
        read(text);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    return "nothing was thrown";
}

const std::string good_yaml =
    "# a page\n"
    "REFERENCES: 'A. Author, <a href=\"x\"><i>J.</i> 1</a>,   2'\n"
    "COMMENTS: |\n"
    "  at room\n"
    "  temperature\n"
    "DATA:\n"
    "  - type: tabulated nk\n"
    "    data: |\n"
    "        0.4 1.5 0.1\n"
    "        0.5 1.6 0.2\n"
    "        0.7 1.8 0\n";

TEST(OpticalConstantsYaml, ReadsATableWithItsPublication) {
    const OpticalConstantsFile file = parse_optical_constants_yaml(good_yaml, "a.yml", "paint");
    EXPECT_EQ(file.constants.name(), "paint");
    EXPECT_EQ(file.constants.citation(), "A. Author, J. 1, 2");
    EXPECT_EQ(file.comments, "at room temperature");
    EXPECT_DOUBLE_EQ(file.constants.wavelength_min_nm(), 400);
    EXPECT_DOUBLE_EQ(file.constants.wavelength_max_nm(), 700);
    EXPECT_TRUE(file.constants.k_known());
    EXPECT_NEAR(std::abs(file.constants.at(450) - Complex(1.55, 0.15)), 0.0, 1e-15);
    EXPECT_EQ(file.constants.at(700), Complex(1.8, 0.0));
}

TEST(OpticalConstantsYaml, CombinesAFormulaForNWithATableForK) {
    const OpticalConstants m = yaml(
        "DATA:\n  - type: formula 5\n    wavelength_range: 0.4 1.0\n    coefficients: 1.5 0.01 -2\n"
        "  - type: tabulated k\n    data: \"0.5 0.1\\n0.9 0.3\"\n");
    EXPECT_DOUBLE_EQ(m.wavelength_min_nm(), 500);
    EXPECT_DOUBLE_EQ(m.wavelength_max_nm(), 900);
    EXPECT_NEAR(m.at(700).real(), 1.5 + 0.01 / 0.49, 1e-15);
    EXPECT_NEAR(m.at(700).imag(), 0.2, 1e-15);
}

// Each formula by hand at l = 0.5 um, coefficients chosen so that every one of them matters.
TEST(DispersionFormula, AllNineByHand) {
    const double l = 0.5, l2 = 0.25;
    const auto n = [&](int number, std::vector<double> c) { return DispersionFormula(number, std::move(c))(l); };
    EXPECT_DOUBLE_EQ(n(1, {0.1, 1.2, 0.2}), std::sqrt(1 + 0.1 + 1.2 * l2 / (l2 - 0.04)));
    EXPECT_DOUBLE_EQ(n(2, {0.1, 1.2, 0.2}), std::sqrt(1 + 0.1 + 1.2 * l2 / (l2 - 0.2)));
    EXPECT_DOUBLE_EQ(n(3, {2.2, 0.1, 2, 0.01, -2}), std::sqrt(2.2 + 0.1 * l2 + 0.01 / l2));
    EXPECT_DOUBLE_EQ(n(4, {2.2, 0.3, 1, 0.4, 2, 0.2, 2, 0.1, 1, 0.05, 3}),
                     std::sqrt(2.2 + 0.3 * l / (l2 - 0.16) + 0.2 * l2 / (l2 - 0.1) + 0.05 * l * l2));
    EXPECT_DOUBLE_EQ(n(4, {2.2, 0.3, 1, 0.4, 2}), std::sqrt(2.2 + 0.3 * l / (l2 - 0.16)));
    EXPECT_DOUBLE_EQ(n(5, {1.5, 0.01, -2, 0.001, -4}), 1.5 + 0.01 / l2 + 0.001 / (l2 * l2));
    EXPECT_DOUBLE_EQ(n(6, {1e-4, 0.05, 200}), 1 + 1e-4 + 0.05 / (200 - 1 / l2));
    const double pole = 1 / (l2 - 0.028);
    EXPECT_DOUBLE_EQ(n(7, {1.5, 0.01, 1e-4, 1e-3, 1e-4, 1e-5}),
                     1.5 + 0.01 * pole + 1e-4 * pole * pole + 1e-3 * l2 + 1e-4 * l2 * l2 + 1e-5 * l2 * l2 * l2);
    const double ratio = n(8, {0.3, 0.05, 0.1, 0.01});
    EXPECT_DOUBLE_EQ((ratio * ratio - 1) / (ratio * ratio + 2), 0.3 + 0.05 * l2 / (l2 - 0.1) + 0.01 * l2);
    EXPECT_DOUBLE_EQ(n(9, {2.2, 0.1, 0.05, 0.02, 0.2, 0.3}),
                     std::sqrt(2.2 + 0.1 / (l2 - 0.05) + 0.02 * 0.3 / (0.09 + 0.3)));
    EXPECT_TRUE(std::isnan(n(3, {-1.0})));
}

TEST(OpticalConstantsYaml, ErrorsNameThePlace) {
    const auto edited = [](std::string_view from, std::string_view to) {
        std::string text = good_yaml;
        text.replace(text.find(from), from.size(), to);
        return text;
    };
    const std::string formula =
        "DATA:\n  - type: formula 2\n    wavelength_range: 0.4 1.0\n    coefficients: 0 1.2 0.1\n";
    const auto edited_formula = [&](std::string_view from, std::string_view to) {
        std::string text = formula;
        text.replace(text.find(from), from.size(), to);
        return text;
    };
    const std::pair<std::string, const char*> cases[] = {
        {"", "a.yml: no optical constants"},
        {"just words", "a.yml: no optical constants"},
        {"A: 1\n", "a.yml:1:1: no DATA"},
        {"DATA: 5\n", "a.yml:1:7: DATA is not a list"},
        {"DATA: []\n", "a.yml:1:7: DATA is not a list"},
        {"DATA:\n  - 5\n", "a.yml:2:5: an entry of DATA is not a map"},
        {"DATA:\n  - data: 5\n", "a.yml:2:5: no type"},
        {"DATA:\n  - type: [1]\n", "a.yml:2:11: type is not text"},
        {"DATA:\n  - type: tabulated x\n", "a.yml:2:11: unknown type \"tabulated x\""},
        {"DATA:\n  - type: tabulated nk\n", "a.yml:2:5: no data"},
        {"DATA:\n  - type: tabulated nk\n    data: [1]\n", "a.yml:3:11: data is not text"},
        {"DATA:\n  - type: tabulated nk\n    data: ''\n", "a.yml:3:11: \"tabulated nk\" has no rows"},
        {"DATA: [\n", "a.yml:2:1: not readable as YAML"},
        {std::string(100000, '['), "not readable as YAML"},
        {edited("0.5 1.6 0.2", "0.5 1.6"), "a.yml:10:9: 2 numbers in a row of \"tabulated nk\""},
        {edited("0.5 1.6 0.2", "0.5 1.6 0.2 7"), "a.yml:10:9: 4 numbers in a row"},
        {edited("0.5 1.6 0.2", "0.5 1.6 -0.2"), "a.yml:10:17: k = -0.2"},
        {edited("0.5 1.6 0.2", "0.5 0 0.2"), "a.yml:10:13: n = 0"},
        {edited("0.5 1.6 0.2", "0.5 nan 0.2"), "a.yml:10:13: \"nan\" is not a finite number"},
        {edited("0.5 1.6 0.2", "0.5 1e999 0.2"), "a.yml:10:13: \"1e999\" is not a finite number"},
        {edited("0.5 1.6 0.2", "0.5  1.6x 0.2"), "a.yml:10:14: \"1.6x\" is not a finite number"},
        {edited("0.5 1.6 0.2", "-0.5 1.6 0.2"), "a.yml:10:9: wavelength -0.5"},
        {edited("0.5 1.6 0.2", "0.4 1.6 0.2"), "a.yml:10:9: wavelength 0.4 stands twice"},
        {edited("0.5 1.6 0.2", "0.3 1.6 0.2"), "a.yml:10:9: wavelength 0.3 follows 0.4"},
        {edited("tabulated nk", "tabulated k"), "3 numbers in a row of \"tabulated k\""},
        {"DATA:\n  - type: tabulated k\n    data: |\n      0.4 1\n", "n is missing"},
        {good_yaml + "  - type: tabulated n\n    data: |\n      0.4 1\n", "a.yml:12:5: n is given twice"},
        {good_yaml + "  - type: formula 1\n", "a.yml:12:5: no wavelength_range"},
        {formula + "  - type: tabulated k\n    data: |\n      2 0\n", "no common wavelength"},
        {edited_formula("formula 2", "formula 0"), "a.yml:2:11: unknown formula \"0\""},
        {edited_formula("formula 2", "formula 10"), "a.yml:2:11: unknown formula \"10\""},
        {edited_formula("formula 2", "formula x"), "known: formula 1 to formula 9"},
        {edited_formula("0.4 1.0", "1.0 0.4"), "a.yml:3:23: the wavelength range is not"},
        {edited_formula("0.4 1.0", "0.4"), "a.yml:3:23: the wavelength range is not"},
        {edited_formula("0.4 1.0", "0 1"), "a.yml:3:23: the wavelength range is not"},
        {edited_formula("0 1.2 0.1", "0 1.2"), "a.yml:4:19: formula 2 has 1, 3, 5, ... coefficients, not 2"},
        {edited_formula("0 1.2 0.1", "''"), "a.yml:4:19: formula 2 has 1, 3, 5, ... coefficients, not 0"},
        {edited_formula("0 1.2 0.1", "0 x 0.1"), "a.yml:4:21: \"x\" is not a finite number"},
        {edited_formula("0 1.2 0.1", "[0, {}, 1]"), "coefficients holds something that is not a number"},
        {edited_formula("0 1.2 0.1", "{a: 1}"), "a.yml:4:19: coefficients is not a list of numbers"},
        {edited_formula("0 1.2 0.1", "-3 1.2 0.1"), "gives no positive index at"},
        {edited_formula("coefficients", "coefficient"), "a.yml:2:5: no coefficients"},
    };
    for (const auto& [text, expected] : cases)
        EXPECT_THAT(message_of(yaml, text), HasSubstr(expected)) << text.substr(0, 300);
}

TEST(OpticalConstantsCsv, ReadsMicrometresOrNanometresWithCommentsAndEmptyCells) {
    const OpticalConstantsFile file = parse_optical_constants_csv(
        "\xEF\xBB\xBF# publication: B. Writer (1999)\r\n# comments: film\r\n\r\nwavelength_nm, n, k\r\n400,1.5,0.1 # "
        "first\r\n"
        "500,1.6,\r\n600,1.7,0.3\r\n800,1.8,\r\n",
        "a.csv", "film");
    EXPECT_EQ(file.constants.citation(), "B. Writer (1999)");
    EXPECT_EQ(file.comments, "film");
    EXPECT_DOUBLE_EQ(file.constants.wavelength_max_nm(), 600);  // k ends there
    EXPECT_NEAR(std::abs(file.constants.at(500) - Complex(1.6, 0.2)), 0.0, 1e-15);

    const OpticalConstants n_only = csv("k,n,wavelength_um\n,1.5,0.4\n,1.7,0.6");
    EXPECT_FALSE(n_only.k_known());
    EXPECT_NEAR(n_only.at(500).real(), 1.6, 1e-15);
    EXPECT_EQ(csv("wavelength_um,n\n0.4,1.5\n").at(400), Complex(1.5, 0.0));
}

TEST(OpticalConstantsCsv, ErrorsNameThePlace) {
    const std::pair<const char*, const char*> cases[] = {
        {"", "a.csv: no optical constants"},
        {"# nothing\n\n", "a.csv: no optical constants"},
        {"wavelength_um,n,k\n", "a.csv: no rows"},
        {"0.4,1.5,0\n", "a.csv:1:1: unknown column \"0.4\""},
        {"wavelength_um,n,n\n", "a.csv:1:17: second column \"n\""},
        {"wavelength_um,wavelength_nm,n\n", "a.csv:1:15: second column \"wavelength_nm\""},
        {"wavelength_um,k\n0.4,1\n", "a.csv:1: no column n"},
        {"n,k\n0.4,1\n", "a.csv:1: no column wavelength_um"},
        {"wavelength_um,n,k\n0.4,1.5\n", "a.csv:2: 2 cells in a row"},
        {"wavelength_um,n,k\n0.4,1.5,0\n0.5,,0\n", "a.csv:3:5: \"\" is not a finite number"},
        {"wavelength_um,n,k\n0.4,1.5,0\n0.5,-1,0\n", "a.csv:3:5: n = -1"},
        {"wavelength_um,n,k\n0.4,1.5,-1e-9\n", "a.csv:2:9: k = -1e-09"},
        {"wavelength_um,n,k\n0.4,1.5,inf\n", "a.csv:2:9: \"inf\" is not a finite number"},
        {"wavelength_um,n,k\n0.4,1.5,0\n0.4,1.5,0\n", "a.csv:3:1: wavelength 0.4 stands twice"},
        {"wavelength_um,n,k\n0.4,1.5,0\n 0.3,1.5,0\n", "a.csv:3:2: wavelength 0.3 follows 0.4"},
        {"wavelength_um,n,k\n0,1.5,0\n", "a.csv:2:1: wavelength 0"},
    };
    for (const auto& [text, expected] : cases) EXPECT_THAT(message_of(csv, text), HasSubstr(expected)) << text;
}

// Whatever happens to a file, reading it gives physical constants or an Error(input): no other exception, no crash.
TEST(OpticalConstantsFile, SurvivesDamage) {
    const std::string good_csv = "# publication: x\nwavelength_um,n,k\n0.4,1.5,0.1\n0.5,1.6,0.2\n0.7,1.8,\n";
    const std::string formula =
        "DATA:\n  - type: formula 4\n    wavelength_range: 0.4 1.0\n    coefficients: 2 1.2 0 0.1 1\n";
    std::mt19937 random(7);
    const std::string alphabet = "0123456789.-+eE \n\t|:[]{}'\"#,nk\\&*%!>\x01\xff";
    int accepted = 0, refused = 0;
    for (const std::string& original : {good_yaml, good_csv, formula})
        for (int trial = 0; trial < 2000; ++trial) {
            // Cut the tail off, or change, remove or insert up to four characters.
            std::string text = original;
            if (trial % 4 == 0) text.resize(random() % text.size());
            for (unsigned edits = random() % 5; edits > 0 && !text.empty(); --edits) {
                const size_t at = random() % text.size();
                const char c = alphabet[random() % alphabet.size()];
                if (random() % 3 == 0)
                    text.erase(at, 1);
                else if (random() % 2 == 0)
                    text.insert(at, 1, c);
                else
                    text[at] = c;
            }
            try {
                const OpticalConstants m = original == good_csv ? csv(text) : yaml(text);
                const Complex index = m.at(0.5 * (m.wavelength_min_nm() + m.wavelength_max_nm()));
                EXPECT_TRUE(index.real() > 0.0 && index.imag() >= 0.0) << text;
                ++accepted;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::input) << text;
                ++refused;
            }
        }
    EXPECT_GT(accepted, 1000);  // the damage is not so heavy that nothing is left to read
    EXPECT_GT(refused, 1000);
}

TEST(OpticalConstantsFile, IsFoundBesideTheRecipeByItsExtension) {
    const ScratchFolder folder;
    std::ofstream(folder / "mine.yml") << good_yaml;
    std::ofstream(folder / "mine.csv") << "wavelength_nm,n\n400,1.4\n700,1.4\n";
    EXPECT_EQ(material("mine.yml", folder).name(), "mine");
    EXPECT_EQ(material("mine.csv", folder).at(550), Complex(1.4, 0.0));
    EXPECT_EQ(material((folder / "mine.csv").string()).at(550), Complex(1.4, 0.0));
    EXPECT_EQ(material("gold", folder).name(), "Au");
    EXPECT_THROW(material("absent.yml", folder), Error);
    EXPECT_THROW(read_optical_constants(folder / "mine.txt"), Error);
    EXPECT_THROW(read_optical_constants(folder), Error);
}

}  // namespace
}  // namespace patina::optics
