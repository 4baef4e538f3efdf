// A paint under a rough interface: Fourier orders on quadrature rays against facets drawn in a random walk.
//
// Both have the same law of the surface, written down twice (rt/rough_interface.h, rt/monte_carlo/rough_top.h): what is
// held here are frames, signs, Fresnel's matrices in the facets' own planes, the expansion on the rays, the cells of
// the refracted lobes and the energy given back.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "patina/core/constants.h"
#include "patina/rt/solver.h"
#include "patina/rt/test_problems.h"

namespace patina::rt {
namespace {

using optics::Stokes;

struct RoughCase {
    const char* name;
    RoughSurface surface;
    Base base;
    double cell_error;  // of the deterministic solution, relative to I: the rays' cells smooth the refracted lobes
};

class RoughInterfaceCross : public testing::TestWithParam<RoughCase> {};

TEST_P(RoughInterfaceCross, DoublingAgreesWithMonteCarlo) {
    const RoughCase& c = GetParam();
    const Problem problem{1.0, {{0.7, 0.98, testing_problems::physical_expansion(3), 1.5}}, c.base, c.surface};
    const FieldRequest request{0.7, {1.0, 0.3, 0.4, 0.5}, {0.0, 0.4}, {0.45, 0.85}, {0.3, 2.2}};
    const Field expected = solver_named("doubling").field(problem, request, {.streams = 12});
    const Field found = solver_named("montecarlo").field(problem, request, {.samples = 60'000, .seed = 5});

    const auto compare = [&](const auto& a, const auto& b, const auto& error) {
        for (std::size_t d = 0; d < a.size(); ++d)
            for (std::size_t o = 0; o < a[d].size(); ++o)
                for (std::size_t p = 0; p < a[d][o].size(); ++p)
                    for (int s = 0; s < 4; ++s)
                        EXPECT_NEAR(a[d][o][p][s], b[d][o][p][s],
                                    4.0 * error[d][o][p][s] + c.cell_error * a[d][o][p][0])
                            << c.name << " depth " << d << " view " << o << " azimuth " << p << " Stokes " << s;
    };
    compare(expected.upward, found.upward, found.upward_error);
    compare(expected.downward, found.downward, found.downward_error);
}

INSTANTIATE_TEST_SUITE_P(
    Surfaces, RoughInterfaceCross,
    // A mirror shows the refracted lobes as they are, cells and all; 12 % would be missing were their
    // Fourier series as short as the reflected ones'.
    testing::Values(RoughCase{"BeckmannOverMetal", {0.77, FacetDistribution::beckmann}, MetalBase{{2.6, 2.9}}, 0.015},
                    RoughCase{"Ggx", {0.3, FacetDistribution::ggx}, LambertianBase{0.5}, 0.002},
                    RoughCase{"Beckmann", {0.2, FacetDistribution::beckmann}, BlackBase{}, 0.002}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace patina::rt
