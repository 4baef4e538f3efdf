// Three methods on recipes drawn over the legal input space: doubling, eigenmodes and Monte Carlo agree within what
// each says of its error. PATINA_RANDOM_RECIPES=1000 draws more of them.

#include "random_recipes.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "patina/coating/optical_problem.h"
#include "patina/core/files.h"
#include "patina/core/scratch_folder_for_tests.h"
#include "patina/rt/solver.h"

namespace patina::cross {
namespace {

namespace fs = std::filesystem;
using optics::Stokes;

// Directions where no quadrature has a node and nothing is singular.
const rt::FieldRequest request{0.66, {1.0, 0.3, -0.2, 0.4}, {0.0}, {0.35, 0.93}, {0.7, 2.6}};

std::vector<Stokes> flat(const std::vector<std::vector<std::vector<Stokes>>>& levels) {
    std::vector<Stokes> values;
    for (const auto& view : levels.front()) values.insert(values.end(), view.begin(), view.end());
    return values;
}

double largest(const std::vector<Stokes>& values) {
    double result = 0.0;
    for (const Stokes& value : values) result = std::max(result, value.cwiseAbs().maxCoeff());
    return result;
}

double largest_difference(const std::vector<Stokes>& a, const std::vector<Stokes>& b) {
    double result = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) result = std::max(result, (a[k] - b[k]).cwiseAbs().maxCoeff());
    return result;
}

// Scatterings that a packet of the random walk can have; its time goes with them.
double scatterings(const rt::Problem& problem) {
    double sum = 0.0;
    for (const rt::Layer& layer : problem.layers)
        sum += std::min(layer.optical_thickness, 1.0 / (1.0 - layer.single_scattering_albedo + 1e-4));
    return sum;
}

class RandomRecipes : public ::testing::Test {
  protected:
    RandomRecipes() {
        write_text_file(folder_ / "rayleigh.csv",
                        "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2\n0,1,0,0,0,0,0\n1,0,0,0,1.5,0,0\n"
                        "2,0.5,3,0,0,1.2247448713915890,0\n");
    }

    rt::Problem problem(std::uint64_t seed) {
        const std::vector<std::string> expansions{
            "rayleigh.csv", (fs::path(PATINA_SOURCE_DIR) / "examples/data/siewert_problem_IIA.csv").string()};
        text_ = RandomRecipe(seed, expansions).text();
        return coating::optical_problem(coating::parse_recipe(text_, "random.toml", folder_), 550.0, 1e-4).problem;
    }

    std::vector<Stokes> solve(const char* solver, const rt::Problem& problem, int streams) {
        return flat(
            rt::solver_named(solver).field(problem, request, {.streams = streams, .fourier_tolerance = 1e-9}).upward);
    }

    const ScratchFolder folder_;
    std::string text_;
};

int wanted_recipes() {
    const char* more = std::getenv("PATINA_RANDOM_RECIPES");
    return more ? std::atoi(more) : 50;
}

TEST_F(RandomRecipes, ThreeMethodsAgreeWithinTheirErrors) {
    const rt::Solver &eigenmodes = rt::solver_named("eigenmodes"), &monte_carlo = rt::solver_named("montecarlo");
    int with_eigenmodes = 0, with_monte_carlo = 0, deviations = 0;
    double sum_of_squares = 0.0;
    for (int seed = 1; seed <= wanted_recipes(); ++seed) {
        const rt::Problem what = problem(seed);
        SCOPED_TRACE(fmt::format("seed {}\n{}", seed, text_));
        constexpr int few = 8, many = 13;
        const std::vector<Stokes> coarse = solve("doubling", what, few), fine = solve("doubling", what, many);
        const double scale = largest(fine);
        ASSERT_TRUE(std::isfinite(scale));

        // The same discretization by two methods. Eigenmodes of a nearly conservative layer (albedo 0.9999 is their
        // limit) lose half of the digits.
        if (eigenmodes.unsupported(what).empty()) {
            EXPECT_LE(largest_difference(solve("eigenmodes", what, few), coarse), 1e-7 * scale);
            ++with_eigenmodes;
        }

        // The random walk knows no streams: to its standard error comes what the streams leave, less than what the
        // finer solution changed.
        if (!monte_carlo.unsupported(what).empty() || scale == 0.0) continue;
        ++with_monte_carlo;
        const auto samples =
            static_cast<std::int64_t>(std::clamp(60'000.0 / (1.0 + scatterings(what)), 1024.0, 8192.0));
        const rt::Field walked =
            monte_carlo.field(what, request, {.samples = samples, .seed = static_cast<std::uint64_t>(seed)});
        const std::vector<Stokes> value = flat(walked.upward), error = flat(walked.upward_error);
        // Cells of so few streams smooth the lobes of a rough top (tests/cross/rough_interface_monte_carlo_test.cpp).
        const double cell_error = what.has_rough_top() ? 0.015 : 0.0;
        for (std::size_t k = 0; k < value.size(); ++k)
            for (int c = 0; c < 4; ++c) {
                // Linear interpolation of the walk's scattering functions: 1e-4 (its header).
                const double systematic =
                    std::abs(fine[k][c] - coarse[k][c]) + (1e-4 + cell_error) * fine[k][0] + 1e-14;
                const double z = (value[k][c] - fine[k][c]) / std::hypot(error[k][c], systematic);
                // One value of fresh seeds exceeds 5 with a probability of 2e-6 (Student's t of 128 batches), any of
                // 40 recipes' 16 values with 1e-3.
                EXPECT_LT(std::abs(z), 5.0) << "direction " << k << " component " << c << ": " << value[k][c] << " +- "
                                            << error[k][c] << ", doubling " << fine[k][c] << " +- " << systematic;
                if (error[k][c] > 3.0 * systematic) {
                    sum_of_squares += z * z;
                    ++deviations;
                }
            }
    }
    RecordProperty("with_eigenmodes", with_eigenmodes);
    RecordProperty("with_monte_carlo", with_monte_carlo);
    // Enough of each, and deviations of the size that their errors promise: the mean square of n values, correlated
    // within a recipe's 16, is 1 to about sqrt(2 * 16 / n) = 0.3, were they fully so.
    EXPECT_GE(with_eigenmodes, wanted_recipes() / 4);
    EXPECT_GE(with_monte_carlo, wanted_recipes() / 2);
    ASSERT_GE(deviations, 4 * wanted_recipes());
    EXPECT_NEAR(sum_of_squares / deviations, 1.0, 0.4);
}

}  // namespace
}  // namespace patina::cross
