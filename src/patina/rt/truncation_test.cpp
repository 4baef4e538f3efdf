#include "patina/rt/truncation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "patina/core/constants.h"
#include "patina/rt/solver.h"
#include "patina/rt/test_problems.h"

namespace patina::rt {
namespace {

using testing_problems::physical_expansion;

// A realizable law with a forward peak: half of a smooth one, half a Henyey-Greenstein function times the identity, of
// which the delta of the truncation is the limit.
optics::ExpansionCoefficients peaked(double g, int order) {
    optics::ExpansionCoefficients x = physical_expansion(3);
    for (auto* list : {&x.alpha1, &x.alpha2, &x.alpha3, &x.alpha4, &x.beta1, &x.beta2}) {
        list->resize(order + 1, 0.0);
        for (double& value : *list) value *= 0.5;
    }
    // Multiplying cos^2(theta/2) on the Mueller identity's elements would be needed for d^l_22 to vanish backward; the
    // peak is narrow enough that what is left there does not matter to linear transfer.
    for (int l = 0; l <= order; ++l) {
        const double peak = 0.5 * (2 * l + 1) * std::pow(g, l);
        x.alpha1[l] += peak;
        x.alpha4[l] += peak;
        if (l >= 2) x.alpha2[l] += peak;
        if (l >= 2) x.alpha3[l] += peak;
    }
    return x;
}

Problem coarse(double index, Base base) {
    return {1.0, {{1.2, 0.97, peaked(0.75, 48), index}}, base};
}

double largest_error(const Field& a, const Field& b) {
    double worst = 0.0;
    for (std::size_t d = 0; d < a.upward.size(); ++d)
        for (std::size_t o = 0; o < a.upward[d].size(); ++o)
            for (std::size_t p = 0; p < a.upward[d][o].size(); ++p)
                worst = std::max({worst, (a.upward[d][o][p] - b.upward[d][o][p]).cwiseAbs().maxCoeff(),
                                  (a.downward[d][o][p] - b.downward[d][o][p]).cwiseAbs().maxCoeff()});
    return worst;
}

Field field_of(const Problem& problem, int streams) {
    // Away from the peak itself, whose second order is not corrected.
    const FieldRequest request{0.6, {1, 0.3, -0.2, 0.4}, {0.0, 0.5, 1.2}, {0.3, 0.9}, {1.0, 2.5}};
    return solver_named("doubling").field(problem, request, {.streams = streams, .fourier_tolerance = 1e-7});
}

TEST(Truncation, KeepsWhatShortExpansionsHave) {
    const Problem problem = coarse(1.0, BlackBase{});
    EXPECT_EQ(truncate(problem, 25).order, 0);
    const Truncation t = truncate(problem, 8);
    EXPECT_EQ(t.scaled.layers[0].expansion.order(), 15);
    EXPECT_NEAR(t.forward[0], 0.5 * std::pow(0.75, 16), 1e-14);
    EXPECT_NEAR(t.scaled.layers[0].expansion.alpha1[0], 1.0, 1e-15);
    // The scaled transport cross section is the whole one: tau (1 - omega g).
    const auto transport = [](const Layer& layer) {
        return layer.optical_thickness * (1 - layer.single_scattering_albedo * layer.expansion.asymmetry());
    };
    EXPECT_NEAR(transport(t.scaled.layers[0]), transport(problem.layers[0]), 1e-14);
    EXPECT_NEAR(t.scaled_depth(problem, 1.2), t.scaled.layers[0].optical_thickness, 1e-15);
}

// A long expansion whose terms beyond the 2N-th vanish is the short one, whatever the correction does.
TEST(Truncation, OfVanishingTermsChangesNothing) {
    Problem shorter{1.0, {{1.2, 0.95, physical_expansion(2, 8), 1.5}}, MetalBase{{0.96, 6.69}}}, longer = shorter;
    auto& x = longer.layers[0].expansion;
    for (auto* list : {&x.alpha1, &x.alpha2, &x.alpha3, &x.alpha4, &x.beta1, &x.beta2}) list->resize(40, 0.0);
    EXPECT_LT(largest_error(field_of(shorter, 8), field_of(longer, 8)), 1e-12);
}

// Delta-M with exact single scattering against enough streams for the whole expansion (26 carry 52 terms, of 49).
TEST(Truncation, AgreesWithManyStreams) {
    const Problem problems[] = {coarse(1.0, LambertianBase{0.3}), coarse(1.5, MetalBase{{0.96, 6.69}})};
    for (const Problem& problem : problems) {
        const Field whole = field_of(problem, 26), few = field_of(problem, 8);
        double scale = 0.0;
        for (const auto& level : whole.upward)
            for (const auto& view : level)
                for (const auto& s : view) scale = std::max(scale, s[0]);
        // f = 0.5 0.75^16 = 0.5 % of the light is in the truncated part; second and higher orders of it are what errs.
        EXPECT_LT(largest_error(few, whole), 2e-3 * scale);
    }
}

// The reflection's correction rests on reciprocity, the field's on adding upwards: the same light.
TEST(Truncation, CorrectsFieldAndReflectionAlike) {
    const Problem problem{
        1.0,
        {{0.4, 0.97, peaked(0.8, 40), 1.5}, {0.0, 0.5, physical_expansion(1), 1.5}, {0.7, 1.0, peaked(0.7, 30), 1.35}},
        MetalBase{{0.96, 6.69}}};
    const SolveOptions options{.streams = 6, .fourier_tolerance = 0.0};
    const Reflection r = solver_named("doubling").reflection(problem, options);
    EXPECT_EQ(r.modes.size(), 41u);
    for (int column = 0; column < 4; ++column) {
        const FieldRequest request{r.mu[3], optics::Stokes::Unit(column), {0.0}, {r.mu[1], r.mu[5]}, {0.7}};
        const Field field = solver_named("doubling").field(problem, request, options);
        for (int view : {0, 1}) {
            const int o = view == 0 ? 1 : 5;
            optics::Stokes expected = optics::Stokes::Zero();
            for (std::size_t m = 0; m < r.modes.size(); ++m) {
                const double c = (m ? 2 : 1) * std::cos(0.7 * m), s = (m ? 2 : 1) * std::sin(0.7 * m);
                const optics::Stokes f = r.modes[m].block<4, 1>(4 * o, 4 * 3 + column);
                expected += column < 2 ? optics::Stokes(c * f[0], c * f[1], s * f[2], s * f[3])
                                       : optics::Stokes(-s * f[0], -s * f[1], c * f[2], c * f[3]);
            }
            // Rounding; radiances are of the order of 1.
            EXPECT_LT((field.upward[0][view][0] - pi * r.mu[3] * expected).cwiseAbs().maxCoeff(), 1e-11);
        }
    }
}

// A layer in two halves has the field of the whole one at every level, the correction included.
TEST(Truncation, DoesNotDependOnHowALayerIsCut) {
    const auto x = peaked(0.8, 40);
    const Problem whole{1.0, {{1.2, 0.97, x, 1.5}}, MetalBase{{0.96, 6.69}}};
    const Problem halves{1.0, {{0.4, 0.97, x, 1.5}, {0.8, 0.97, x, 1.5}}, MetalBase{{0.96, 6.69}}};
    EXPECT_LT(largest_error(field_of(whole, 8), field_of(halves, 8)), 1e-11);
}

}  // namespace
}  // namespace patina::rt
