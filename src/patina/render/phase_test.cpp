// Phase functions: what must hold for any scattering matrix of randomly oriented particles, on every one of them.

#include <complex>

#include <gtest/gtest.h>

#include "patina/optics/scattering/mie.h"
#include "patina/render/light_beam.h"
#include "patina/render/medium.h"
#include "patina/render/random.h"
#include "patina/render/scene_resources.h"
#include "patina/render/test_support.h"

namespace patina::render::test {
namespace {

const SceneResources no_resources;

Phase phase_of(const Node& phase) {
    std::map<std::string, std::string> notes;
    const Node medium = node("medium", "homogeneous", {}, {phase});
    return build_medium(*medium, {&no_resources, &notes}).phase;
}

Node mie(double radius_um, double eta, double k) {
    return node("phase", "mie", {{"radius_um", radius_um}, uniform("eta", eta), uniform("k", k), {"binder", 1.5}});
}

struct Case {
    std::string name;
    Phase phase;
};
const std::vector<Case>& cases() {
    static const std::vector<Case> all = {
        {"isotropic", phase_of(node("phase", "isotropic"))},
        {"forward", phase_of(node("phase", "hg", {{"g", 0.9}}))},
        {"backward", phase_of(node("phase", "hg", {{"g", -0.4}}))},
        {"nearly isotropic", phase_of(node("phase", "hg", {{"g", 5e-4}}))},
        {"dipole", phase_of(node("phase", "rayleigh"))},
        {"air", phase_of(node("phase", "rayleigh", {{"depolarization", 0.028}}))},
        {"pigment", phase_of(mie(0.12, 2.7, 0))},
        {"coarse", phase_of(mie(1.0, 1.33, 0.01))},
        {"sizes", phase_of(node("phase", "mie",
                                {{"distribution", std::string("lognormal")},
                                 {"median_radius_um", 0.1},
                                 {"sigma_g", 1.3},
                                 uniform("eta", 2.7),
                                 uniform("k", 0.0)}))},
    };
    return all;
}
const Wavelengths light = Wavelengths::sample(0.13f);

// The mean of g(cosine) over the sphere: Gauss-free, by midpoints dense at both poles.
template <class Function>
Float4 mean_over_cosines(const Function& g) {
    constexpr int steps = 4000;
    Float4 total{};
    for (int i = 0; i < steps; ++i) {
        const double theta = pi * (i + 0.5) / steps;
        total += g(static_cast<float>(std::cos(theta))) * static_cast<float>(0.5 * pi / steps * std::sin(theta));
    }
    return total;
}

TEST(EveryPhaseFunction, IsNormalized) {
    for (const Case& c : cases()) {
        const Float4 norm = mean_over_cosines([&](float x) { return phase_elements(c.phase, light, x).a1; });
        // Midpoints of 0.8 mrad and single precision.
        for (int lane = 0; lane < 4; ++lane) EXPECT_NEAR(norm[lane], 1, 2e-4) << c.name;
    }
}

// A scattering matrix of spheres, or of a mix of such: coherency eigenvalues are not negative (van de Hulst 1957,
// section 5.22; Hovenier & van der Mee 1988).
TEST(EveryPhaseFunction, IsRealizable) {
    for (const Case& c : cases())
        for (double theta = 0; theta <= 180; theta += 1.5) {
            PhaseElements f = phase_elements(c.phase, light, static_cast<float>(std::cos(radians(theta))));
            if (f.kind == PhaseElements::Kind::scalar) continue;
            if (f.kind == PhaseElements::Kind::sphere) f.a2 = f.a1, f.a4 = f.a3;
            for (int lane = 0; lane < 4; ++lane) {
                const double a1 = f.a1[lane], a2 = f.a2[lane], a3 = f.a3[lane], a4 = f.a4[lane], b1 = f.b1[lane],
                             b2 = f.b2[lane];
                const double tolerance = 1e-5 * a1 * a1;  // of single precision
                EXPECT_LE(4 * b2 * b2 + (a3 + a4) * (a3 + a4) + 4 * b1 * b1, (a1 + a2) * (a1 + a2) + tolerance)
                    << c.name << " " << theta;
                EXPECT_LE(std::abs(a3 - a4), a1 - a2 + tolerance / a1) << c.name << " " << theta;
            }
        }
}

// The same light path run backwards: reversed(F(k_in, k_out)) = F(-k_out, -k_in).
TEST(EveryPhaseFunction, IsReciprocal) {
    const Vec3 in = Vec3(0.3f, -0.5f, 0.7f).normalized(), out = Vec3(-0.6f, 0.2f, 0.4f).normalized();
    for (const Case& c : cases()) {
        const PhaseElements f = phase_elements(c.phase, light, in.dot(out));
        const ScatteringMatrix there = reversed(phase_matrix(f, in, out)), back = phase_matrix(f, -out, -in);
        if (f.kind == PhaseElements::Kind::scalar) continue;
        const optics::Mueller turned =
            rotate_frames(there.matrix(0), -out, there.x_in, back.x_in, -in, there.x_out, back.x_out);
        EXPECT_LT((turned - back.matrix(0)).norm(), 1e-5 * f.a1[0]) << c.name;  // single precision
    }
}

// Draws land in each twentieth of the range as often as the density says.
TEST(EveryPhaseFunction, DrawsFromItsOwnDensity) {
    constexpr int bins = 20, draws = 40'000;
    for (const Case& c : cases()) {
        const int lane = 2;
        std::vector<double> expected(bins), found(bins);
        constexpr int steps = 40'000;
        for (int i = 0; i < steps; ++i) {
            const double x = -1 + 2 * (i + 0.5) / steps;
            expected[static_cast<std::size_t>(i * bins / steps)] +=
                phase_elements(c.phase, light, static_cast<float>(x)).a1[lane] * draws / steps;
        }
        Sampler sampler(7, 0, 1);
        for (int i = 0; i < draws; ++i) {
            const float x = phase_sample_cosine(c.phase, light, lane, (i + sampler.next()) / draws);
            ASSERT_TRUE(x >= -1 && x <= 1) << c.name;
            ++found[static_cast<std::size_t>(std::min(bins - 1, static_cast<int>((x + 1) * 0.5f * bins)))];
        }
        // Stratified: each bin misses by a draw or two at its edges, and by the midpoints' error in peaks.
        for (int b = 0; b < bins; ++b)
            EXPECT_NEAR(found[b], expected[b], 4 + 1e-3 * expected[b]) << c.name << " bin " << b;
    }
}

TEST(PhaseFunctions, HenyeyGreensteinHasItsMeanCosine) {
    for (double g : {-0.4, 5e-4, 0.9}) {
        const Phase phase = phase_of(node("phase", "hg", {{"g", g}}));
        const Float4 mean = mean_over_cosines([&](float x) { return x * phase_elements(phase, light, x).a1; });
        EXPECT_NEAR(mean[0], g, 2e-4);  // midpoints
    }
}

// Natural light at 90 degrees: (1 - rho)/(1 + rho) polarized, across the scattering plane.
TEST(PhaseFunctions, RayleighPolarizesByItsDepolarizationFactor) {
    for (double rho : {0.0, 0.028, 0.3}) {
        const Phase phase = phase_of(node("phase", "rayleigh", {{"depolarization", rho}}));
        const PhaseElements f = phase_elements(phase, light, 0.0f);
        EXPECT_NEAR(f.b1[0] / f.a1[0], -(1 - rho) / (1 + rho), 1e-6);
    }
}

// The field that a small dipole sends, and that of a sphere by its amplitudes, in fixed axes of space.
TEST(PhaseFunctions, MatrixIsThatOfFields) {
    const float radius = 0.15f;
    const Phase phase = phase_of(mie(radius, 2.0, 0.02));
    const Wavelengths w = Wavelengths::all_at(500);  // a row of the table
    const optics::MieSphere sphere(2 * pi * radius * 1.5 / 0.5, std::complex<double>(2.0, 0.02) / 1.5);
    const Vec3 in = Vec3(0.1f, 0.2f, -0.9f).normalized();
    for (const Vec3& direction : {Vec3(0.5f, 0.3f, 0.8f), Vec3(-0.9f, 0.1f, 0.1f), Vec3(0.2f, 0.2f, -0.7f)}) {
        const Vec3 out = direction.normalized();
        const double cosine = in.dot(out);
        const optics::MieAmplitudes s = sphere.amplitudes(std::span(&cosine, 1));
        // E_s' = S1 E_s, E_p' = S2 E_p with s x p = k and s across the plane (Bohren & Huffman 1983, eq. 3.12; common
        // factors left out). In the renderer's frame x = p, y = -s.
        Eigen::Matrix2cd jones = Eigen::Matrix2cd::Zero();
        jones(0, 0) = s.s2[0], jones(1, 1) = s.s1[0];
        const std::complex<double> i(0, 1);
        const Eigen::Vector4d stokes(1, 0.3, -0.5, 0.7);
        Eigen::Matrix2cd coherence;  // E_a E_b*: U = 2 Re(Ex Ey*), V = 2 Im(Ex Ey*)
        coherence << stokes[0] + stokes[1], stokes[2] + i * stokes[3], stokes[2] - i * stokes[3], stokes[0] - stokes[1];
        coherence = 0.5 * (jones * coherence * jones.adjoint()).eval();
        Eigen::Vector4d expected((coherence(0, 0) + coherence(1, 1)).real(), (coherence(0, 0) - coherence(1, 1)).real(),
                                 2 * coherence(0, 1).real(), 2 * coherence(0, 1).imag());
        const ScatteringMatrix m = phase_matrix(phase_elements(phase, w, static_cast<float>(cosine)), in, out);
        Eigen::Vector4d found = m.matrix(0) * stokes;
        found /= m.matrix(0)(0, 0);
        expected /= 0.5 * (std::norm(s.s1[0]) + std::norm(s.s2[0]));
        EXPECT_LT((found - expected).norm(), 3e-3) << found.transpose() << "\n" << expected.transpose();  // the table's
        EXPECT_GT(std::abs(m.m[3][0]), 0.004 * m.m[0][0]);  // there is a retardance to see
    }
}

}  // namespace
}  // namespace patina::render::test
