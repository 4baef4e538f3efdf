#include "patina/jobs/compare.h"

#include "patina/brdf/tabulate.h"
#include "patina/core/constants.h"
#include "patina/core/error.h"

namespace patina::jobs {
namespace {

brdf::MuellerTable lambertian(double reflectance, std::vector<double> wavelengths_nm = {500.0, 600.0}) {
    brdf::TabulateOptions options;
    options.wavelengths_nm = std::move(wavelengths_nm);
    return brdf::tabulate(brdf::lambertian_body(reflectance), options);
}

TEST(Compare, ATableDoesNotDifferFromItself) {
    const brdf::MuellerTable table = brdf::tabulate(brdf::single_rayleigh_body(1.0));
    const auto rows = compare_tables(table, table);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].f00.largest, 0.0);
    EXPECT_EQ(rows[0].dolp.largest, 0.0);
    EXPECT_EQ(rows[0].mueller[2][3].largest, 0.0);
    EXPECT_EQ(rows[0].albedo.largest, 0.0);
}

// Two Lambertian surfaces differ by their reflectances over pi, and in no ratio.
TEST(Compare, LambertianSurfacesDifferByTheirReflectance) {
    const auto rows = compare_tables(lambertian(0.5), lambertian(0.6));
    ASSERT_EQ(rows.size(), 2u);
    for (const TableDifference& row : rows) {
        // Rounding of modes and interpolation.
        EXPECT_NEAR(row.f00.root_mean_square, 0.1 / pi, 1e-12);
        EXPECT_NEAR(row.f00.largest, 0.1 / pi, 1e-12);
        EXPECT_NEAR(row.mean_f00, 0.5 / pi, 1e-12);
        EXPECT_NEAR(row.albedo.largest, 0.1, 1e-12);
        EXPECT_NEAR(row.dolp.largest, 0.0, 1e-12);
    }
}

// Rayleigh scattering polarizes completely at right angles; a Lambertian surface not at all.
TEST(Compare, PolarizationIsSeenInDolpAndElements) {
    const auto rows = compare_tables(lambertian(0.5, {550.0}), brdf::tabulate(brdf::single_rayleigh_body(1.0)));
    EXPECT_GT(rows[0].dolp.largest, 0.9);
    EXPECT_GT(rows[0].mueller[1][0].largest, 0.5);
}

TEST(Compare, TablesWithoutACommonWavelengthAreRefused) {
    EXPECT_THROW(compare_tables(lambertian(0.5), lambertian(0.5, {700.0})), Error);
}

}  // namespace
}  // namespace patina::jobs
