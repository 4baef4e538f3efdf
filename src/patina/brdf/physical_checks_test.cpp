#include "patina/brdf/physical_checks.h"

#include <gtest/gtest.h>

#include "patina/brdf/tabulate.h"
#include "patina/core/constants.h"
#include "patina/optics/fresnel.h"

namespace patina::brdf {
namespace {

using optics::Mueller;

MuellerTable deep_rayleigh_table() {
    return tabulate(single_rayleigh_body(std::numeric_limits<double>::infinity()),
                    {.wavelengths_nm = {450, 650}, .nodes = 8, .orders = 3});
}

// Passed or not, by name.
std::map<std::string, PhysicalCheck> by_name(const MuellerTable& table) {
    std::map<std::string, PhysicalCheck> result;
    for (PhysicalCheck& check : check_physics(table)) result[check.name] = check;
    return result;
}

std::string failed(const MuellerTable& table) {
    std::string names;
    for (const PhysicalCheck& check : check_physics(table))
        if (!check.passed) names += check.name + " ";
    return names;
}

TEST(CoherencyEigenvalues, AreThoseOfKnownMatrices) {
    // An ideal depolarizer spreads over all four, a pure (Jones) element has one, and they sum to M00.
    const Mueller depolarizer = Eigen::Vector4d(1, 0, 0, 0).asDiagonal();
    EXPECT_LT((coherency_eigenvalues(depolarizer) - Eigen::Vector4d::Constant(0.25)).norm(), 1e-15);
    const Mueller metal = optics::fresnel_reflection(0.3, 1.0, {0.8, 5.0});
    EXPECT_LT((coherency_eigenvalues(metal) - Eigen::Vector4d(0, 0, 0, metal(0, 0))).norm(), 1e-14);
    EXPECT_LT((coherency_eigenvalues(rayleigh_phase_matrix(0.3, 0.8, 1.1)).head<3>()).norm(), 1e-14);
    // "Reversing U alone" is no sum of Jones matrices.
    EXPECT_NEAR(coherency_eigenvalues(optics::reversal())[0], -0.5, 1e-14);
}

TEST(PhysicalChecks, PhysicalTablesPass) {
    EXPECT_EQ(failed(deep_rayleigh_table()), "");
    EXPECT_EQ(failed(tabulate(lambertian_body(1.0), {.nodes = 4, .orders = 1})), "");
    EXPECT_EQ(failed(tabulate(lambertian_body(0.0), {.nodes = 4, .orders = 1})), "");
}

TEST(PhysicalChecks, EachBrokenLawIsNamedWithItsPlace) {
    MuellerTable table = deep_rayleigh_table();
    table.body[1].modes[0](4 * 2, 4 * 5) *= 1.01;  // only one sense of the path
    EXPECT_EQ(failed(table), "reciprocity ");
    const PhysicalCheck check = by_name(table)["reciprocity"];
    EXPECT_EQ(check.wavelength_nm, 650);
    const double theta_a = degrees(std::acos(table.mu[2])), theta_b = degrees(std::acos(table.mu[5]));
    EXPECT_NEAR(std::min(check.theta_o_deg, check.theta_i_deg), theta_b, 1e-9);
    EXPECT_NEAR(std::max(check.theta_o_deg, check.theta_i_deg), theta_a, 1e-9);
    EXPECT_NEAR(check.worst, 0.01, 1e-3);

    table = deep_rayleigh_table();
    for (Eigen::MatrixXd& mode : table.body[0].modes)
        for (Eigen::Index row = 0; row < mode.rows(); ++row)
            for (Eigen::Index column = 0; column < mode.cols(); ++column)
                if (row % 4 != 0 || column % 4 != 0) mode(row, column) *= 1.1;  // polarizes beyond 100 %
    EXPECT_NE(failed(table).find("realizability"), std::string::npos);
    EXPECT_EQ(by_name(table)["realizability"].wavelength_nm, 450);

    table = deep_rayleigh_table();
    table.body[0].modes[0](2, 0) = 0.01;
    EXPECT_NE(failed(table).find("mirror_symmetry"), std::string::npos);

    table = tabulate(
        [](double, double, double, double phi) -> Mueller {
            return Mueller(Eigen::Vector4d(0.1 + 0.12 * std::cos(phi), 0, 0, 0).asDiagonal());
        },
        {.nodes = 4, .orders = 2});
    EXPECT_NE(failed(table).find("positivity"), std::string::npos);
    EXPECT_EQ(by_name(table)["positivity"].phi_deg, 180);
}

// A Lambertian body of 0.98 below a surface that reflects 4 % of one polarization only: too much for that one alone.
TEST(PhysicalChecks, EnergyCountsTheWorstPolarizationAndTheSpecularPart) {
    MuellerTable table = tabulate(lambertian_body(0.98), {.nodes = 4, .orders = 1});
    EXPECT_EQ(failed(table), "");
    Mueller polarizer = Mueller::Zero();
    polarizer.topLeftCorner<2, 2>() << 1, -1, -1, 1;
    for (Mueller& mueller : table.specular_surface[0]) mueller = 0.019 * polarizer;  // unpolarized: 0.999
    EXPECT_EQ(failed(table), "energy ");
    EXPECT_NEAR(by_name(table)["energy"].worst, 0.98 + 2 * 0.019 - 1, 1e-9);
    table.error_estimate = {0.02};  // the table admits to more
    EXPECT_EQ(failed(table), "");
}

// A thin index-matched layer is steep near grazing: few nodes undershoot between each other, and the check says so.
TEST(PhysicalChecks, UndershootBetweenTheNodesIsReported) {
    const MuellerTable table = tabulate(single_rayleigh_body(0.01), {.nodes = 6, .orders = 3});
    const PhysicalCheck check = by_name(table)["interpolation"];
    EXPECT_FALSE(check.passed);
    EXPECT_GT(check.worst, check.tolerance);
    EXPECT_EQ(failed(table), "interpolation ");
}

}  // namespace
}  // namespace patina::brdf
