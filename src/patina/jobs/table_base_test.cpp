// A table as base of a coating.

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "patina/coating/optical_problem.h"
#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/core/scratch_folder_for_tests.h"
#include "patina/io/table_hdf5.h"
#include "patina/jobs/solve.h"
#include "patina/rt/solver.h"

namespace patina::jobs {
namespace {

namespace fs = std::filesystem;

class TableBase : public testing::Test {
  protected:
    TableBase() {
        std::ofstream(folder_ / "law.csv") << "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2\n"
                                              "0,1,0,0,0,0,0\n1,0.9,0,0,0.8,0,0\n2,0.5,1.2,0.6,0.4,0.3,0.1\n"
                                              "3,0.1,0.3,0.2,0.1,0.1,0.05\n";
    }

    static std::string layer(double thickness) {
        return "[[layers]]\noptical_thickness = " + std::to_string(thickness) +
               "\nsingle_scattering_albedo = 0.95\nexpansion = \"law.csv\"\nrefractive_index = 1.5\n";
    }
    // The file of a solved coating that others lie on.
    void write_primer_table(const std::string& text, int streams) const {
        SolveRequest request;
        request.streams = streams;
        io::write_table_hdf5(solve(coating::parse_recipe(text, "r.toml", folder_), request).table,
                             folder_ / "primer.h5");
    }
    rt::Problem problem_of(const std::string& text) const {
        return coating::optical_problem(coating::parse_recipe(text, "r.toml", folder_), 550.0).problem;
    }
    rt::Reflection reflection_of(const std::string& text, int streams) const {
        return rt::solver_named("doubling").reflection(problem_of(text), {.streams = streams});
    }
    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
    // Largest difference of any mode, 1/sr.
    static double difference(const rt::Reflection& a, const rt::Reflection& b) {
        double worst = 0.0;
        for (std::size_t m = 0; m < std::min(a.modes.size(), b.modes.size()); ++m)
            worst = std::max(worst, (a.modes[m] - b.modes[m]).cwiseAbs().maxCoeff());
        return worst;
    }
    // Directional-hemispherical reflectance of unpolarized light without the mirrored part.
    static Eigen::VectorXd albedo(const rt::Reflection& r) {
        const int n = static_cast<int>(r.mu.size());
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(n);
        for (int i = 0; i < n; ++i)
            for (int o = 0; o < n; ++o) sum[i] += 2 * pi * r.weights[o] * r.mu[o] * r.modes[0](4 * o, 4 * i);
        return sum;
    }

    ScratchFolder folder_;
};

const std::string metal = "[base]\ntype = \"metal\"\nmaterial = { n = 1.0, k = 6.5 }\n";
const std::string on_table = "[base]\ntype = \"table\"\nfile = \"primer.h5\"\n", on_recipe =
                                                                                     "[base]\ntype = \"recipe\"\n"
                                                                                     "recipe = \"primer.toml\"\n";
const std::string surface = "[interface]\ntype = \"smooth\"\n";

// A coating over a coating by its recipe and by its table, diffuse and mirrored parts: the same to rounding on the same
// nodes (the mirrored part goes through the table's cubic in half degrees: 1e-6).
TEST_F(TableBase, IsTheCoatingItWasMadeOf) {
    write("primer.toml", layer(0.4) + metal);
    write_primer_table(layer(0.4) + metal, 8);
    EXPECT_LT(difference(reflection_of(layer(0.3) + on_recipe, 8), reflection_of(layer(0.3) + on_table, 8)), 2e-6);
    const rt::Problem expected = problem_of(layer(0.3) + on_recipe), found = problem_of(layer(0.3) + on_table);
    for (double mu : {0.2, 0.6, 0.95})
        EXPECT_LT((rt::specular_coherent(expected, mu) - rt::specular_coherent(found, mu)).cwiseAbs().maxCoeff(), 2e-6);
}

// Under an interface the rays are others than the table's nodes: the table's polynomials come in, and the energy stays
// that of the table.
TEST_F(TableBase, IsInterpolatedUnderAnInterface) {
    write("primer.toml", layer(0.4) + metal);
    write_primer_table(layer(0.4) + metal, 16);
    const rt::Reflection expected = reflection_of(surface + layer(0.3) + on_recipe, 8),
                         found = reflection_of(surface + layer(0.3) + on_table, 8);
    EXPECT_LT((albedo(expected) - albedo(found)).cwiseAbs().maxCoeff(), 1e-4);
    // The primer without an interface is steep at grazing angles (like 1/(mu_o + mu_i)), where its polynomials err
    // most.
    EXPECT_LT(difference(expected, found), 5e-4 * expected.modes[0].cwiseAbs().maxCoeff());
}

// A table of directions in air lies below a gap of air.
TEST_F(TableBase, InAirIsSeenThroughAGap) {
    write_primer_table(surface + layer(0.4) + metal, 10);
    const std::string coated = surface + layer(0.3) + on_table;
    const auto optical = coating::optical_problem(coating::parse_recipe(coated, "r.toml", folder_), 550.0);
    ASSERT_EQ(optical.problem.layers.size(), 2u);
    EXPECT_EQ(optical.problem.layers[1].refractive_index, 1.0);
    EXPECT_EQ(optical.notes.size(), 1u);

    // Built by hand: the coating, a gap without extinction, the primer with its own interface.
    const std::string gap =
        "[[layers]]\noptical_thickness = 0\nsingle_scattering_albedo = 0\nexpansion = \"law.csv\"\n";
    const rt::Reflection expected = reflection_of(surface + layer(0.3) + gap + layer(0.4) + metal, 10),
                         found = reflection_of(coated, 10);
    EXPECT_LT(difference(expected, found), 1e-5 * expected.modes[0].cwiseAbs().maxCoeff());
}

TEST_F(TableBase, SaysWhatItIsNot) {
    const auto complaint = [&](const std::string& base) -> std::string {
        try {
            (void)coating::parse_recipe(layer(0.3) + base, "r.toml", folder_);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(complaint(on_table).find("file not found"), std::string::npos);
    EXPECT_NE(complaint("[base]\ntype = \"table\"\nfile = \"law.csv\"\n").find(".h5"), std::string::npos);
    EXPECT_NE(complaint("[base]\ntype = \"none\"\nfile = \"law.csv\"\n").find("only a base"), std::string::npos);

    // Directions in an unknown medium.
    write_primer_table(layer(0.4), 6);
    brdf::MuellerTable table = io::read_table_hdf5(folder_ / "primer.h5");
    table.provenance.notes.clear();
    io::write_table_hdf5(table, folder_ / "primer.h5");
    EXPECT_NE(complaint(on_table).find("refractive_index = 1"), std::string::npos);
    EXPECT_EQ(complaint(on_table + "refractive_index = 1.5\n"), "");
}

}  // namespace
}  // namespace patina::jobs
