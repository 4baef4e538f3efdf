// A table as base of a coating.

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "patina/coating/optical_problem.h"
#include "patina/core/error.h"
#include "patina/io/table_hdf5.h"
#include "patina/jobs/solve.h"

namespace patina::jobs {
namespace {

namespace fs = std::filesystem;

class TableBase : public testing::Test {
  protected:
    TableBase() : folder_(fs::temp_directory_path() / "patina_table_base_test") {
        fs::create_directories(folder_);
        std::ofstream(folder_ / "law.csv") << "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2\n"
                                              "0,1,0,0,0,0,0\n1,1.2,0,0,0.9,0,0\n2,0.9,3.1,0.4,0.6,0.3,0.2\n"
                                              "3,0.3,0.9,0.3,0.2,0.1,0.1\n";
    }
    ~TableBase() override { fs::remove_all(folder_); }

    static std::string layer(double thickness) {
        return "[[layers]]\noptical_thickness = " + std::to_string(thickness) +
               "\nsingle_scattering_albedo = 0.95\nexpansion = \"law.csv\"\nrefractive_index = 1.5\n";
    }
    brdf::MuellerTable solved(const std::string& text, int streams) const {
        SolveRequest request;
        request.streams = streams;
        request.tolerance = 1e-6;
        return solve(coating::parse_recipe(text, "r.toml", folder_), request).table;
    }
    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
    // Largest difference of any mode, 1/sr.
    static double difference(const brdf::MuellerTable& a, const brdf::MuellerTable& b) {
        double worst = 0.0;
        for (std::size_t m = 0; m < std::min(a.body[0].modes.size(), b.body[0].modes.size()); ++m)
            worst = std::max(worst, (a.body[0].modes[m] - b.body[0].modes[m]).cwiseAbs().maxCoeff());
        return worst;
    }

    fs::path folder_;
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
    io::write_table_hdf5(solved(layer(0.4) + metal, 12), folder_ / "primer.h5");
    const brdf::MuellerTable expected = solved(layer(0.3) + on_recipe, 12), found = solved(layer(0.3) + on_table, 12);
    EXPECT_LT(difference(expected, found), 2e-6);
    for (double mu : {0.2, 0.6, 0.95})
        EXPECT_LT((expected.specular(550.0, mu) - found.specular(550.0, mu)).cwiseAbs().maxCoeff(), 2e-6);
}

// Under an interface the rays are others than the table's nodes: the table's polynomials come in, and the energy stays
// that of the table.
TEST_F(TableBase, IsInterpolatedUnderAnInterface) {
    write("primer.toml", layer(0.4) + metal);
    io::write_table_hdf5(solved(layer(0.4) + metal, 24), folder_ / "primer.h5");
    const brdf::MuellerTable expected = solved(surface + layer(0.3) + on_recipe, 10),
                             found = solved(surface + layer(0.3) + on_table, 10);
    for (double mu : {0.1, 0.5, 0.9}) EXPECT_NEAR(found.body_albedo(550.0, mu), expected.body_albedo(550.0, mu), 1e-5);
    // The primer without an interface is steep at grazing angles (like 1/(mu_o + mu_i)), where its polynomials err
    // most.
    EXPECT_LT(difference(expected, found), 2e-4 * expected.body[0].modes[0].cwiseAbs().maxCoeff());
}

// A table of directions in air lies below a gap of air.
TEST_F(TableBase, InAirIsSeenThroughAGap) {
    write("primer.toml", surface + layer(0.4) + metal);
    io::write_table_hdf5(solved(surface + layer(0.4) + metal, 12), folder_ / "primer.h5");
    const auto problem =
        coating::optical_problem(coating::parse_recipe(surface + layer(0.3) + on_table, "r.toml", folder_), 550.0);
    ASSERT_EQ(problem.problem.layers.size(), 2u);
    EXPECT_EQ(problem.problem.layers[1].refractive_index, 1.0);
    EXPECT_EQ(problem.notes.size(), 1u);

    // Built by hand: the coating, a gap without extinction, the primer with its own interface.
    const std::string gap =
        "[[layers]]\noptical_thickness = 0\nsingle_scattering_albedo = 0\nexpansion = \"law.csv\"\n";
    const brdf::MuellerTable expected = solved(surface + layer(0.3) + gap + layer(0.4) + metal, 12),
                             found = solved(surface + layer(0.3) + on_table, 12);
    EXPECT_LT(difference(expected, found), 1e-5 * expected.body[0].modes[0].cwiseAbs().maxCoeff());
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
    brdf::MuellerTable table = solved(layer(0.4), 6);
    table.provenance.notes.clear();
    io::write_table_hdf5(table, folder_ / "primer.h5");
    EXPECT_NE(complaint(on_table).find("refractive_index = 1"), std::string::npos);
    EXPECT_EQ(complaint(on_table + "refractive_index = 1.5\n"), "");
}

}  // namespace
}  // namespace patina::jobs
