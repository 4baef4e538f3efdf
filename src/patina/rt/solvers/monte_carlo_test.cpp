#include "patina/rt/solvers/monte_carlo.h"

#include <limits>

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/math/quadrature.h"
#include "patina/optics/fresnel.h"

namespace patina::rt {
namespace {

using optics::ExpansionCoefficients;
using optics::Stokes;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Rayleigh scattering without depolarization (Hovenier & van der Mee 1983, table 2, for this normalisation).
ExpansionCoefficients rayleigh() {
    return {{1, 0, 0.5}, {0, 0, 3}, {0, 0, 0}, {0, 1.5, 0}, {0, 0, std::sqrt(6.0) / 2}, {0, 0, 0}};
}

// All six functions nonzero and no symmetry between angles; a Mueller matrix at every angle.
ExpansionCoefficients generic() {
    return {{1, 0.9, 0.5, 0.1}, {0, 0, 1.6, 0.2},  {0, 0, 1.0, 0.1},
            {0.3, 0.7, 0.3, 0}, {0, 0, 0.4, -0.1}, {0, 0, 0.3, 0.1}};
}

Field solve(const Problem& problem, const FieldRequest& request, std::int64_t samples = 40'000,
            std::uint64_t seed = 3) {
    return make_monte_carlo_solver()->field(problem, request, {.samples = samples, .seed = seed});
}

// Largest deviation in standard errors; components whose error is below 1e-13 must agree to 1e-12.
double deviation(const Stokes& value, const Stokes& error, const Stokes& expected) {
    double worst = 0.0;
    for (int c = 0; c < 4; ++c) {
        const double off = std::abs(value[c] - expected[c]);
        worst = std::max(worst, error[c] > 1e-13 ? off / error[c] : off / 1e-12);
    }
    return worst;
}

// All tests: fixed seeds; n normal values exceed 4.5 sigma with probability 7e-6 n, below 1e-3 each test in a fresh
// seed.
constexpr double sigmas = 4.5;

// Single scattering into the plane of incidence: flux pi of the beam gives L = (w/4) (tau/mu) F S for tau -> 0.
// Meridian and scattering planes coincide, so their frames differ by half turns at most, which Stokes vectors do not
// see.
TEST(MonteCarlo, BecomesSingleScatteringInAThinLayer) {
    const double tau = 1e-5, mu0 = 0.8;
    const ExpansionCoefficients c = generic();
    const FieldRequest request{mu0, {1.0, 0.2, 0.3, 0.4}, {0.0, tau}, {0.3, 0.9}, {0.0, pi}};
    const Field field = solve({1.0, {{tau, 0.7, c, 1.0}}, BlackBase{}}, request, 2000);
    for (std::size_t o = 0; o < 2; ++o)
        for (std::size_t p = 0; p < 2; ++p)
            for (bool up : {true, false}) {
                const double mu = request.mu_o[o], along = p == 0 ? 1.0 : -1.0;
                const double x = along * std::sqrt((1 - mu * mu) * (1 - mu0 * mu0)) + (up ? -mu : mu) * mu0;
                // F of degree 3, from explicit polynomials (Siewert 1982; P3, and d^l_mn of l = 2, 3).
                const double p2 = 1.5 * x * x - 0.5, p3 = 2.5 * x * x * x - 1.5 * x;
                const double d2 = std::sqrt(6.0) / 4 * (1 - x * x), d3 = std::sqrt(30.0) / 4 * x * (1 - x * x);
                const double plus = 0.25 * (1 + x) * (1 + x) * (2.6 + 0.3 * (3 * x - 2));
                const double minus = 0.25 * (1 - x) * (1 - x) * (0.6 + 0.1 * (3 * x + 2));
                const double a1 = 1 + 0.9 * x + 0.5 * p2 + 0.1 * p3, a4 = 0.3 + 0.7 * x + 0.3 * p2;
                const double b1 = -0.4 * d2 + 0.1 * d3, b2 = -0.3 * d2 - 0.1 * d3;
                optics::Mueller f;
                f << a1, b1, 0, 0, b1, (plus + minus) / 2, 0, 0, 0, 0, (plus - minus) / 2, b2, 0, 0, -b2, a4;
                const Stokes expected = 0.7 / 4 * tau / mu * (f * request.incident);
                const auto& value = (up ? field.upward : field.downward)[up ? 0 : 1][o][p];
                const auto& error = (up ? field.upward_error : field.downward_error)[up ? 0 : 1][o][p];
                // tau (1/mu + 1/mu0)/2 of the exponential, and F linear between nodes: 1e-4 relative.
                EXPECT_LT((value - expected).norm(), 1e-4 * expected[0] + sigmas * error.norm()) << value << "\n\n"
                                                                                                 << expected;
            }
}

// Without scattering the light is Beer's: in through the interface, to the base, out, with the internal reflections of
// diffuse light by an integral over angles: L = E T(mu_o) exp(-tau/mu) / (n^2 pi), E = mu0 pi T exp(-tau/mu0') rho / (1
// - rho r), r = 2 int R(mu) exp(-2 tau/mu) mu dmu.
TEST(MonteCarlo, ReproducesAnAbsorbingVarnishOverALambertianBase) {
    const double n = 1.5, tau = 0.4, rho = 0.8, mu0 = 0.6;
    const auto inside = [n](double mu) { return std::sqrt(1 - (1 - mu * mu) / (n * n)); };
    double r = 0.0;
    const double critical = std::sqrt(1 - 1 / (n * n));
    for (const auto& rule : {math::gauss_legendre(60, 0, critical), math::gauss_legendre(60, critical, 1)})
        for (int i = 0; i < rule.size(); ++i) {
            const double mu = rule.nodes[static_cast<std::size_t>(i)];
            r += 2 * rule.weights[static_cast<std::size_t>(i)] * mu * optics::fresnel_reflection(mu, n, 1.0)(0, 0) *
                 std::exp(-2 * tau / mu);
        }
    const Stokes incident(1, 0.5, 0, 0.3);
    const double entering = (optics::fresnel_transmission(mu0, 1.0, n) * incident)[0];
    const double exitance = mu0 * pi * entering * std::exp(-tau / inside(mu0)) * rho / (1 - rho * r);

    const FieldRequest request{mu0, incident, {0.0, tau}, {0.1, 0.5, 1.0}, {0.3, 2.0}};
    const Field field = solve({1.0, {{tau, 0.0, rayleigh(), n}}, LambertianBase{rho}}, request);
    for (std::size_t o = 0; o < 3; ++o) {
        const double mu = request.mu_o[o];
        const Stokes expected = exitance / pi / (n * n) * std::exp(-tau / inside(mu)) *
                                optics::fresnel_transmission(inside(mu), n, 1.0).col(0);
        EXPECT_LT(deviation(field.upward[0][o][1], field.upward_error[0][o][1], expected), sigmas);
        EXPECT_LT(deviation(field.upward[1][o][1], field.upward_error[1][o][1], {exitance / pi, 0, 0, 0}), sigmas);
        const Stokes down = exitance / pi * std::exp(-2 * tau / mu) * optics::fresnel_reflection(mu, n, 1.0).col(0);
        EXPECT_LT(deviation(field.downward[1][o][0], field.downward_error[1][o][0], down), sigmas);
    }
}

// Nothing absorbs: what the interface does not reflect at once comes out diffusely. Flux by quadrature over exact
// directions (their errors are correlated: added, not squared).
TEST(MonteCarlo, ReturnsAllLightFromAWhiteFurnace) {
    const std::vector<Problem> furnaces{
        {1.0, {{infinity, 1.0, rayleigh(), 1.5}}, BlackBase{}},
        {1.0, {{0.5, 1.0, generic(), 1.33}, {0.3, 1.0, rayleigh(), 1.6}}, LambertianBase{1.0}}};
    for (const Problem& problem : furnaces) {
        const double mu0 = 0.7, n = problem.layers[0].refractive_index;
        const math::Quadrature rule = math::gauss_legendre(8, 0, 1);
        // Four azimuths average all modes up to the order 3 of these expansions.
        const Field field = solve(problem, {mu0, {1, 0, 0, 0}, {0.0}, rule.nodes, {0, pi / 2, pi, 3 * pi / 2}}, 2560);
        double flux = 0.0, error = 0.0;
        for (std::size_t o = 0; o < 8; ++o)
            for (std::size_t p = 0; p < 4; ++p) {
                const double weight = 2 * pi / 4 * rule.weights[o] * rule.nodes[o];
                flux += weight * field.upward[0][o][p][0];
                error += weight * field.upward_error[0][o][p][0];
            }
        const double expected = mu0 * pi * optics::fresnel_transmission(mu0, 1.0, n)(0, 0);
        EXPECT_NEAR(flux / expected, 1.0, sigmas * error / expected + 1e-4);  // 1e-4: the quadrature near grazing
        EXPECT_LT(error / expected, 0.03);
    }
}

// V. Natraj, K.-F. Li & Y. L. Yung (2009), ApJ 691, 1909, corrected Coulson-Dave-Sekera tables: tau 0.5, mu0 0.6;
// columns ground albedo, upward, mu, phi/deg, I, Q, U with their Q = I_perp - I_par turned to ours (U likewise).
struct NatrajRow {
    double albedo;
    bool up;
    double mu, phi_deg, i, q, u;
};
constexpr NatrajRow natraj_rows[] = {
    {0.00, true, 0.20, 60, 0.26996082, 0.03002998, -0.17774346},
    {0.00, true, 0.84, 120, 0.15331865, 0.04365388, -0.00258697},
    {0.80, true, 0.20, 120, 0.51758008, 0.06353366, -0.13854575},
    {0.80, true, 0.84, 60, 0.45492680, 0.00522493, -0.07641022},
    {0.00, false, 0.20, 60, 0.24996736, 0.05469567, -0.10899225},
    {0.00, false, 0.84, 120, 0.10905476, 0.00507873, -0.07168387},
    {0.80, false, 0.20, 120, 0.45267711, 0.02902562, -0.13945569},
    {0.80, false, 0.84, 60, 0.24762179, 0.0411875, -0.00252917},
};

TEST(MonteCarlo, ReproducesRayleighTables) {
    for (const NatrajRow& row : natraj_rows) {
        const Field field = solve({1.0, {{0.5, 1.0, rayleigh(), 1.0}}, LambertianBase{row.albedo}},
                                  {0.6, {1, 0, 0, 0}, {0.0, 0.5}, {row.mu}, {radians(row.phi_deg)}}, 20'000);
        const Stokes value = row.up ? field.upward[0][0][0] : field.downward[1][0][0];
        Stokes error = row.up ? field.upward_error[0][0][0] : field.downward_error[1][0][0];
        error = error.cwiseMax(1e-8);  // the tables' own rounding
        EXPECT_LT(deviation(value, error, {row.i, row.q, row.u, 0.0}), sigmas) << row.mu << " " << row.phi_deg;
        EXPECT_LT(error[0], 0.02 * row.i);
    }
}

// A plane cut through a layer changes nothing, at any level and direction, over a metal and under an interface.
TEST(MonteCarlo, DoesNotSeeACutInALayerOverMetal) {
    const MetalBase aluminium{{0.96, 6.69}};
    const FieldRequest request{0.5, {1, 0.3, 0.4, 0.2}, {0.0, 0.35, 0.6}, {0.2, 0.7}, {0.4, 1.9}};
    const Problem whole{1.0, {{0.6, 0.9, generic(), 1.5}}, aluminium};
    const Problem cut{1.0, {{0.2, 0.9, generic(), 1.5}, {0.4, 0.9, generic(), 1.5}}, aluminium};
    const Field a = solve(whole, request, 20'000, 1), b = solve(cut, request, 20'000, 2);
    for (std::size_t d = 0; d < 3; ++d)
        for (std::size_t o = 0; o < 2; ++o)
            for (std::size_t p = 0; p < 2; ++p) {
                const auto joint = [](const Stokes& x, const Stokes& y) -> Stokes {
                    return (x.array().square() + y.array().square()).sqrt();
                };
                EXPECT_LT(deviation(a.upward[d][o][p], joint(a.upward_error[d][o][p], b.upward_error[d][o][p]),
                                    b.upward[d][o][p]),
                          sigmas);
                EXPECT_LT(deviation(a.downward[d][o][p], joint(a.downward_error[d][o][p], b.downward_error[d][o][p]),
                                    b.downward[d][o][p]),
                          sigmas);
            }
}

// A layer of index 1.5 between air and 1.2 guides light beyond 53 deg: at tau 1e-9 a ray would cross it 1e9 times
// between collisions. First order in tau, the light that leaves upward is the beam scattered once plus what the guide
// collects and scatters on, all of it in time.
TEST(MonteCarlo, IsNotStuckInAThinLightGuide) {
    const FieldRequest request{0.6, {1, 0, 0, 0}, {0.0}, {0.5}, {0.7}};
    const auto radiance = [&](double tau, std::uint64_t seed) {
        const Problem guide{1.0, {{tau, 1.0, rayleigh(), 1.5}, {0.1, 0.0, rayleigh(), 1.2}}, BlackBase{}};
        const Field field = solve(guide, request, 20'000, seed);
        return std::pair<Stokes, Stokes>(field.upward[0][0][0] / tau, field.upward_error[0][0][0] / tau);
    };
    // Radiance per tau is the same at 1e-4 to a relative 1e-3 or so; the ratio of ray crossings is 1e5.
    const auto [thin, thin_error] = radiance(1e-9, 1);
    const auto [thick, thick_error] = radiance(1e-4, 2);
    const Stokes joint = (thin_error.array().square() + thick_error.array().square()).sqrt();
    EXPECT_LT(deviation(thin, joint + Stokes::Constant(2e-3 * thin[0]), thick), sigmas);
    EXPECT_LT(joint[0], 0.05 * thin[0]);
}

// Columns of a Mueller matrix are fields of Stokes vectors that no light has; the field is linear in them.
TEST(MonteCarlo, TakesAnyRealStokesVector) {
    const Problem problem{1.0, {{0.8, 0.95, generic(), 1.5}}, LambertianBase{0.3}};
    const auto run = [&](const Stokes& incident, std::uint64_t seed) {
        const Field field = solve(problem, {0.5, incident, {0.0}, {0.7}, {0.4}}, 40'000, seed);
        return std::pair<Stokes, Stokes>(field.upward[0][0][0], field.upward_error[0][0][0]);
    };
    for (int c = 1; c < 4; ++c) {
        const Stokes unit = Stokes::Unit(c);
        const auto [column, error] = run(unit, 1);
        const auto [plus, plus_error] = run(Stokes::Unit(0) + unit, 2);
        const auto [minus, minus_error] = run(Stokes::Unit(0) - unit, 3);
        const Stokes joint =
            (error.array().square() + 0.25 * plus_error.array().square() + 0.25 * minus_error.array().square()).sqrt();
        EXPECT_LT(deviation(column, joint, 0.5 * (plus - minus)), sigmas) << c;
    }
}

// Reversal of light paths, f(i, o) = D f(o, i)^T D, through three refractive indices and a metal: it ties the beam's
// way in to the local estimate's way out, with all internal reflections.
TEST(MonteCarlo, IsReciprocalInAMultiIndexStack) {
    const Problem stack{1.0,
                        {{0.3, 0.95, generic(), 1.6}, {0.2, 0.9, rayleigh(), 1.2}, {0.4, 0.8, generic(), 1.45}},
                        MetalBase{{0.4, 2.5}}};
    const double mu_a = 0.35, mu_b = 0.9, phi = 1.1;
    const std::vector<Stokes> states{{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 0, 1, 0}, {1, 0, 0, 1}};
    // The reversed path goes from azimuth phi + 180 deg to 180 deg: its relative azimuth is -phi.
    std::array<optics::Mueller, 2> f, error;
    for (std::size_t way : {0u, 1u})
        for (int state = 0; state < 4; ++state) {
            const double in = way == 0 ? mu_a : mu_b, out = way == 0 ? mu_b : mu_a;
            const Field field =
                solve(stack, {in, states[static_cast<std::size_t>(state)], {0.0}, {out}, {way == 0 ? phi : -phi}},
                      20'000, 10 * way + static_cast<std::uint64_t>(state));
            f[way].col(state) = field.upward[0][0][0] / (pi * in);
            error[way].col(state) = field.upward_error[0][0][0] / (pi * in);
        }
    for (auto& m : f)
        for (int c = 1; c < 4; ++c) m.col(c) -= m.col(0).eval();
    for (auto& m : error)
        for (int c = 1; c < 4; ++c) m.col(c) = (m.col(c).array().square() + m.col(0).array().square()).sqrt();
    const optics::Mueller expected = optics::reversal() * f[1].transpose() * optics::reversal();
    const optics::Mueller joint = (error[0].array().square() + error[1].transpose().array().square()).sqrt();
    EXPECT_LT(((f[0] - expected).array().abs() / joint.array()).maxCoeff(), sigmas) << f[0] << "\n\n"
                                                                                    << expected << "\n\n"
                                                                                    << joint;
    EXPECT_LT(joint(0, 0), 0.03 * f[0](0, 0));
}

// The Fourier modes of reflection() sum to the radiances of field(), all sixteen elements.
TEST(MonteCarlo, ReflectionModesSumToTheField) {
    const Problem problem{1.0, {{0.8, 0.95, generic(), 1.5}}, LambertianBase{0.3}};
    const Reflection reflection =
        make_monte_carlo_solver()->reflection(problem, {.streams = 3, .samples = 120'000, .seed = 4});
    ASSERT_EQ(reflection.modes.size(), 4u);
    const double phi = 0.9, mu_i = reflection.mu[1], mu_o = reflection.mu[2];
    optics::Mueller f = optics::Mueller::Zero();
    for (int m = 0; m < 4; ++m) {
        const double factor = m == 0 ? 1.0 : 2.0, c = factor * std::cos(m * phi), s = factor * std::sin(m * phi);
        optics::Mueller trigonometry;
        trigonometry << c, c, -s, -s, c, c, -s, -s, s, s, c, c, s, s, c, c;
        f += trigonometry.cwiseProduct(reflection.modes[static_cast<std::size_t>(m)].block<4, 4>(8, 4));
    }
    for (const Stokes& incident : {Stokes(1, 0.4, 0.5, 0.6), Stokes(1, -0.4, -0.5, 0.6), Stokes(1, 0, 0, -1)}) {
        const Field field = solve(problem, {mu_i, incident, {0.0}, {mu_o}, {phi}}, 40'000);
        // The modes' errors are not returned: with the same number of packets an incidence and a random azimuth, 3
        // times those of the field.
        const Stokes error = 4.0 * field.upward_error[0][0][0];
        EXPECT_LT(deviation(pi * mu_i * f * incident, error, field.upward[0][0][0]), 3.0) << error;
    }
}

TEST(MonteCarlo, GivesTheSameBitsOnAnyNumberOfThreads) {
    const Problem problem{1.0, {{0.8, 0.95, generic(), 1.5}}, LambertianBase{0.3}};
    const FieldRequest request{0.5, {1, 0, 0, 0}, {0.0}, {0.7}, {0.4}};
    set_thread_count(1);
    const Field one = solve(problem, request, 3000);
    set_thread_count(0);
    const Field many = solve(problem, request, 3000), other = solve(problem, request, 3000, 4);
    EXPECT_EQ(one.upward[0][0][0], many.upward[0][0][0]);
    EXPECT_EQ(one.upward_error[0][0][0], many.upward_error[0][0][0]);
    EXPECT_NE(one.upward[0][0][0], other.upward[0][0][0]);
}

// 64 runs: the mean of squared deviations from the common mean in units of the stated errors is 1 +- 0.18 (chi-square
// of 63).
TEST(MonteCarlo, StatesItsErrorsHonestly) {
    const Problem problem{1.0, {{0.8, 0.95, generic(), 1.5}}, LambertianBase{0.3}};
    const int runs = 64;
    std::vector<Field> fields;
    Stokes mean = Stokes::Zero();
    for (int run = 0; run < runs; ++run) {
        fields.push_back(solve(problem, {0.5, {1, 0.2, 0.3, 0.4}, {0.0}, {0.7}, {0.4}}, 1280,
                               100 + static_cast<std::uint64_t>(run)));
        mean += fields.back().upward[0][0][0] / runs;
    }
    Eigen::Array4d chi2 = Eigen::Array4d::Zero();
    for (const Field& field : fields)
        chi2 += ((field.upward[0][0][0] - mean).array() / field.upward_error[0][0][0].array()).square() / (runs - 1);
    EXPECT_GT(chi2.minCoeff(), 1.0 - 4 * 0.18);
    EXPECT_LT(chi2.maxCoeff(), 1.0 + 4 * 0.18);
}

TEST(MonteCarlo, RefusesWhatItCannotEstimate) {
    const Problem problem{1.0, {{0.8, 0.95, generic(), 1.5}}, BlackBase{}};
    EXPECT_THROW(solve(problem, {0.5, {1, 0, 0, 0}, {0.0}, {0.0}, {0.0}}), Error);
    EXPECT_THROW(solve(problem, {0.0, {1, 0, 0, 0}, {0.0}, {0.5}, {0.0}}), Error);
    EXPECT_THROW(solve(problem, {0.5, {1, 0, 0, 0}, {0.9}, {0.5}, {0.0}}), Error);
    EXPECT_THROW(solve(problem, {0.5, {1, 0, 0, 0}, {0.0}, {0.5}, {0.0}}, 1), Error);
}

}  // namespace
}  // namespace patina::rt
