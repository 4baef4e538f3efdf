#include "patina/optics/materials.h"

#include <set>

namespace patina::optics {
namespace {

using ::testing::HasSubstr;
using Complex = std::complex<double>;

std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
}

// Rows of a table made apart from this code, from the same publications, with linear interpolation: DeVore 1951, Querry
// 1985, Johnson & Christy 1972, Rakic & Majewski 1996, Rakic 1995, Beadie 2015 and Zhang 2020, Hale & Querry 1973. It
// prints six significant digits, hence 1e-5 relative.
TEST(Materials, ReproduceAnIndependentTableOfTheirPublications) {
    struct Row {
        double nm, tio2, fe2o3_n, fe2o3_k, au_n, au_k, alas_n, alas_k, al_n, al_k, pmma_n, pmma_k, water_n, water_k;
    };
    const Row rows[] = {
        {430, 2.99455, 2.93733, 1.113, 1.45029, 1.94829, 3.62494, 0.0256369, 0.570372, 5.20855, 1.50376, 1.92e-07,
         1.3378, 1.244e-09},
        {450, 2.92953, 3.057, 0.971, 1.38309, 1.9155, 3.51686, 0.0171908, 0.633238, 5.45435, 1.50159, 1.74e-07, 1.337,
         1.02e-09},
        {460, 2.90241, 3.09033, 0.899667, 1.34893, 1.88515, 3.47387, 0.0142103, 0.668431, 5.57484, 1.50061, 1.46e-07,
         1.3366, 9.86e-10},
        {500, 2.81872, 3.15233, 0.650667, 0.97112, 1.87367, 3.34321, 0.00693192, 0.812565, 6.04806, 1.49733, 1.55e-07,
         1.335, 1e-09},
        {540, 2.76121, 3.15767, 0.522667, 0.488989, 2.33888, 3.25392, 0.00361021, 0.972739, 6.51187, 1.49482, 1.66e-07,
         1.3334, 1.704e-09},
        {550, 2.74958, 3.18767, 0.485333, 0.424149, 2.47205, 3.23584, 0.00309821, 1.01519, 6.62728, 1.49428, 1.74e-07,
         1.333, 1.96e-09},
        {580, 2.71956, 3.21733, 0.278, 0.298776, 2.83742, 3.18886, 0.00199051, 1.15827, 6.96502, 1.49285, 1.92e-07,
         1.3328, 5.06e-09},
        {620, 2.6882, 3.06, 0.104, 0.204754, 3.30385, 3.13955, 0.00115438, 1.36645, 7.40592, 1.49127, 1.98e-07, 1.332,
         1.33e-08},
        {650, 2.66942, 2.967, 0.0723333, 0.155574, 3.60244, 3.10967, 0.000788353, 1.55803, 7.71241, 1.49026, 1.58e-07,
         1.331, 1.64e-08},
        {700, 2.64457, 2.873, 0.0456667, 0.131, 4.0624, 3.0699, 0.000440038, 1.92139, 8.14197, 1.48885, 1.36e-07, 1.331,
         3.35e-08},
        {740, 2.62893, 2.821, 0.0356667, 0.136893, 4.40561, 3.04456, 0.00028671, 2.26714, 8.3881, 1.4879, 1.62e-07,
         1.33, 1.302e-07},
        {780, 2.61607, 2.78, 0.032, 0.147373, 4.74145, 3.02356, 0.000193199, 2.65436, 8.46455, 1.48709, 1.4e-07, 1.3298,
         1.434e-07},
    };
    for (const Row& row : rows) {
        const auto expect = [&](const char* name, double n, double k) {
            const Complex m = builtin_material(name).at(row.nm);
            EXPECT_NEAR(m.real(), n, 1e-5 * n) << name << " at " << row.nm;
            EXPECT_NEAR(m.imag(), k, 1e-5 * k) << name << " at " << row.nm;
        };
        expect("TiO2-rutile", row.tio2, 0.0);
        expect("Fe2O3", row.fe2o3_n, row.fe2o3_k);
        expect("Au", row.au_n, row.au_k);
        expect("AlAs", row.alas_n, row.alas_k);
        expect("Al", row.al_n, row.al_k);
        expect("acrylic", row.pmma_n, row.pmma_k);
        expect("water", row.water_n, row.water_k);
    }
}

// The database's own samples of the dispersion formulas, printed to six decimals.
TEST(Materials, FormulasGiveTheSamplesOfTheDatabase) {
    const std::pair<const char*, double> samples[] = {
        {"Al2O3", 1.770446}, {"SiO2", 1.459911},  {"CaCO3-e", 1.487496},  {"CaCO3-o", 1.661275}, {"ZnO", 2.019756},
        {"ZnS", 2.38621},    {"epoxy", 1.593844}, {"glycerol", 1.472902}, {"acrylic", 1.494284}};
    for (const auto& [name, n] : samples) EXPECT_NEAR(builtin_material(name).at(550).real(), n, 5.1e-7) << name;
    EXPECT_NEAR(builtin_material("HgS-e").at(650).real(), 3.208149, 5.1e-7);
    EXPECT_NEAR(builtin_material("HgS-o").at(650).real(), 2.866755, 5.1e-7);
    EXPECT_NEAR(builtin_material("CaCO3").at(550).real(), (2 * 1.661275 + 1.487496) / 3, 5.1e-7);
}

TEST(Materials, EveryOneNamesItsPublicationAndIsPhysicalOnItsWholeRange) {
    std::set<std::string> names;
    for (const MaterialInfo& info : builtin_materials()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_GT(info.citation.size(), 20u) << info.name;
        EXPECT_FALSE(info.description.empty()) << info.name;
        const OpticalConstants& constants = builtin_material(info.name);
        EXPECT_EQ(constants.name(), info.name);
        for (int i = 0; i <= 200; ++i) {
            const double wavelength_nm =
                std::min(info.wavelength_min_nm + (info.wavelength_max_nm - info.wavelength_min_nm) * i / 200,
                         info.wavelength_max_nm);
            const Complex m = constants.at(wavelength_nm);
            EXPECT_TRUE(m.real() > 0.0 && m.real() < 12.0 && m.imag() >= 0.0 && m.imag() < 12.0)
                << info.name << " " << wavelength_nm << " " << m;
        }
    }
    EXPECT_GE(names.size(), 38u);
}

TEST(Materials, KIsFlaggedWhereThePublicationHasNone) {
    EXPECT_FALSE(builtin_material("TiO2-rutile").k_known());
    EXPECT_FALSE(builtin_material("SiO2").k_known());
    EXPECT_TRUE(builtin_material("Au").k_known());
    EXPECT_TRUE(builtin_material("acrylic").k_known());
}

TEST(Materials, ExtrapolationIsRefusedUnlessAskedFor) {
    const OpticalConstants& rutile = builtin_material("TiO2-rutile");
    EXPECT_DOUBLE_EQ(rutile.wavelength_min_nm(), 430);
    const std::string message = message_of([&] { rutile.at(400); });
    EXPECT_THAT(message, HasSubstr("TiO2-rutile"));
    EXPECT_THAT(message, HasSubstr("430 to 1530 nm"));
    EXPECT_THAT(message, HasSubstr("Devore"));
    EXPECT_EQ(rutile.at(400, Extrapolation::hold), rutile.at(430));
    EXPECT_EQ(rutile.at(1e6, Extrapolation::hold), rutile.at(1530));
    message_of([&] { rutile.at(std::nan(""), Extrapolation::hold); });
    message_of([&] { rutile.at(-1.0, Extrapolation::hold); });
    // The range of acrylic is that of both its n (420-1620 nm) and its k (400-1110 nm).
    EXPECT_DOUBLE_EQ(builtin_material("acrylic").wavelength_min_nm(), 420);
    EXPECT_DOUBLE_EQ(builtin_material("acrylic").wavelength_max_nm(), 1110);
}

TEST(Materials, AliasesCaseAndSuggestions) {
    EXPECT_EQ(builtin_material("rutile").name(), "TiO2-rutile");
    EXPECT_EQ(builtin_material("TiO2").name(), "TiO2-rutile");
    EXPECT_EQ(builtin_material("tio2").name(), "TiO2-rutile");
    EXPECT_EQ(builtin_material("PMMA").name(), "acrylic");
    EXPECT_EQ(builtin_material("Gold").name(), "Au");
    EXPECT_EQ(builtin_material("C").name(), "C");
    EXPECT_THAT(message_of([] {
                    builtin_material("acrilic", {"recipe.toml", 12, 9});
                }),
                HasSubstr("recipe.toml:12:9: unknown material \"acrilic\"; did you mean \"acrylic\"?"));
    EXPECT_THAT(message_of([] { builtin_material("unobtainium"); }), HasSubstr("give a built-in name or a file"));
    message_of([] { builtin_material(""); });
    message_of([] { builtin_material(std::string(1 << 20, 'x')); });
    const std::string ambiguous = message_of([] { builtin_material("iron oxide"); });
    EXPECT_THAT(ambiguous, HasSubstr("Fe2O3 ("));
    EXPECT_THAT(ambiguous, HasSubstr("Fe3O4 ("));
}

TEST(Materials, SearchLooksIntoNamesAndPublications) {
    const std::vector<MaterialInfo> found = search_builtin_materials("johnson");
    EXPECT_EQ(found.size(), 7u);  // Au, Ag, Cu (1972); Cr, Fe, Ni, Ti (1974)
    EXPECT_TRUE(search_builtin_materials("unobtainium").empty());
    EXPECT_EQ(search_builtin_materials("").size(), builtin_materials().size());
}

TEST(OpticalConstants, ConstantHasNoRange) {
    const OpticalConstants m = OpticalConstants::constant({1.5, 0.01});
    EXPECT_EQ(m.at(1.0), Complex(1.5, 0.01));
    EXPECT_EQ(m.at(1e9), Complex(1.5, 0.01));
}

}  // namespace
}  // namespace patina::optics
