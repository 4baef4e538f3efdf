// Stacks of several refractive indices: discrete ordinates with adding against random walks.

#include <cmath>

#include <gtest/gtest.h>

#include "patina/rt/solver.h"
#include "patina/rt/test_problems.h"

namespace patina::rt {
namespace {

using testing_problems::physical_expansion;

// Guided light between total reflections, a thinner medium below a denser one, a metal: at every level, both ways.
TEST(StackCross, OfDifferentIndicesAgreesWithMonteCarloAtEveryLevel) {
    const Problem stacks[] = {
        {1.0,
         {{0.3, 0.95, physical_expansion(2), 1.6},
          {0.2, 0.9, physical_expansion(6), 1.2},
          {0.4, 0.8, physical_expansion(3), 1.45}},
         MetalBase{{0.9, 6.0}}},
        {1.33, {{0.5, 1.0, physical_expansion(4), 1.0}, {0.5, 0.9, physical_expansion(5), 1.5}}, LambertianBase{0.7}}};
    for (const Problem& problem : stacks) {
        double total = 0.0;
        for (const Layer& layer : problem.layers) total += layer.optical_thickness;
        const FieldRequest request{0.8, {1.0, 0.3, -0.4, 0.5}, {0.0, 0.25, total}, {0.35, 0.85}, {0.4, 2.1}};
        const Field expected = solver_named("doubling").field(problem, request, {.streams = 8});
        const Field found = solver_named("montecarlo").field(problem, request, {.samples = 40'000, .seed = 7});
        const auto compare = [&](const auto& a, const auto& b, const auto& error) {
            for (std::size_t d = 0; d < a.size(); ++d)
                for (std::size_t o = 0; o < a[d].size(); ++o)
                    for (std::size_t p = 0; p < a[d][o].size(); ++p)
                        for (int s = 0; s < 4; ++s)
                            // 192 values: one in 1e3 such tests passes 4.5 standard deviations.
                            EXPECT_NEAR(a[d][o][p][s], b[d][o][p][s], 4.5 * error[d][o][p][s] + 1e-6)
                                << "depth " << d << " view " << o << " azimuth " << p << " Stokes " << s;
        };
        compare(expected.upward, found.upward, found.upward_error);
        compare(expected.downward, found.downward, found.downward_error);
    }
}

}  // namespace
}  // namespace patina::rt
