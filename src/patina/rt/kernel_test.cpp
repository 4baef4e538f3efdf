#include "patina/rt/kernel.h"

#include <gtest/gtest.h>

#include "patina/core/constants.h"
#include "patina/math/wigner_d.h"
#include "patina/optics/stokes.h"
#include "patina/rt/nodes.h"
#include "patina/rt/solver.h"
#include "patina/rt/test_problems.h"

namespace patina::rt {
namespace {

using Eigen::Vector3d;
using optics::Mueller;
using testing_problems::physical_expansion;

// A ray with the basis of Bohren & Huffman: p in the meridian plane, s horizontal, s x p = k.
struct Frame {
    Vector3d k, p, s;
};

Frame meridian(double cosine_up, double phi) {
    const double sine = std::sqrt(1 - cosine_up * cosine_up);
    Frame f;
    f.k = {sine * std::cos(phi), sine * std::sin(phi), cosine_up};
    f.p = {cosine_up * std::cos(phi), cosine_up * std::sin(phi), -sine};
    f.s = f.p.cross(f.k);
    return f;
}

// F of the expansion at a scattering angle.
Mueller scattering_matrix(const optics::ExpansionCoefficients& x, double cosine) {
    const int order = x.order();
    const auto d00 = math::wigner_d(order, 0, 0, cosine), d02 = math::wigner_d(order, 0, 2, cosine);
    const auto d22 = math::wigner_d(order, 2, 2, cosine), d2m = math::wigner_d(order, 2, -2, cosine);
    double a1 = 0, a4 = 0, b1 = 0, b2 = 0, plus = 0, minus = 0;
    for (int l = 0; l <= order; ++l) {
        a1 += x.alpha1[l] * d00[l];
        a4 += x.alpha4[l] * d00[l];
        b1 -= x.beta1[l] * d02[l];
        b2 -= x.beta2[l] * d02[l];
        plus += (x.alpha2[l] + x.alpha3[l]) * d22[l];
        minus += (x.alpha2[l] - x.alpha3[l]) * d2m[l];
    }
    Mueller f;
    f << a1, b1, 0, 0, b1, 0.5 * (plus + minus), 0, 0, 0, 0, 0.5 * (plus - minus), b2, 0, 0, -b2, a4;
    return f;
}

// The Mueller matrix that turns Stokes parameters from one transverse basis into another of the same ray: fields
// transform by p' = p cos + s sin.
Mueller rotation(const Vector3d& p, const Vector3d& s, const Vector3d& new_p) {
    const double c = new_p.dot(p), n = new_p.dot(s), c2 = c * c - n * n, s2 = 2 * c * n;
    Mueller m;
    m << 1, 0, 0, 0, 0, c2, s2, 0, 0, -s2, c2, 0, 0, 0, 0, 1;
    return m;
}

// Phase matrix from vectors: into the scattering plane, scatter, out of it.
Mueller phase_matrix(const optics::ExpansionCoefficients& x, const Frame& in, const Frame& out) {
    const Vector3d normal = in.k.cross(out.k).normalized();  // s of both rays in the scattering plane, up to sign
    const Vector3d p_in = in.k.cross(normal), p_out = out.k.cross(normal);
    const Mueller before = rotation(in.p, in.s, p_in);
    const Mueller after = rotation(out.p, out.s, p_out).transpose();
    return after * scattering_matrix(x, in.k.dot(out.k)) * before;
}

// One thin layer scatters once: L = albedo/(4 mu_o) tau F per unit flux of pi. Signs of Q, U, V, of the azimuth and of
// b2 all stand or fall with this, because the right-hand side is made of vectors only.
TEST(Kernel, ScattersOnceAsTheRotatedScatteringMatrix) {
    const auto expansion = physical_expansion(11, 6);
    const double tau = 1e-7, mu_i = 0.6;
    const Problem problem{1.0, {{tau, 1.0, expansion, 1.0}}, BlackBase{}};
    const std::vector<double> mu_o{0.2, 0.75}, phi{0.3, 1.7, 4.0};
    for (int column = 0; column < 4; ++column) {
        const FieldRequest request{mu_i, optics::Stokes::Unit(column), {0.0, tau}, mu_o, phi};
        const Field field = solver_named("doubling").field(problem, request, {.streams = 6});
        for (std::size_t o = 0; o < mu_o.size(); ++o)
            for (std::size_t p = 0; p < phi.size(); ++p) {
                const Frame in = meridian(-mu_i, 0.0);
                const Mueller up = phase_matrix(expansion, in, meridian(mu_o[o], phi[p]));
                const Mueller down = phase_matrix(expansion, in, meridian(-mu_o[o], phi[p]));
                // Second scattering adds a few tau of it.
                const double single = tau / (4 * mu_o[o]);
                EXPECT_LT((field.upward[0][o][p] / single - up.col(column)).norm(), 1e-5)
                    << column << " " << o << " " << p;
                EXPECT_LT((field.downward[1][o][p] / single - down.col(column)).norm(), 1e-5)
                    << column << " " << o << " " << p;
            }
    }
}

TEST(Kernel, IsConservativeOnEveryNodeSet) {
    for (double n : {1.0, 1.05, 1.5}) {
        const Problem problem{1.0, {{1.0, 1.0, physical_expansion(3, 12), n}}, BlackBase{}};
        const Medium medium = medium_of(quadrature_rays(problem, 8), n);
        const auto system = LayerKernel(problem.layers[0], medium).system(0, {0, 2});
        // Elements reach 1/mu^2 = 1e3.
        EXPECT_LT((system.h * system.isotropic).cwiseAbs().maxCoeff(), 1e-12) << n;
        EXPECT_LT((system.h - system.h.transpose()).cwiseAbs().maxCoeff(), 1e-12);
        const auto coupled = LayerKernel(problem.layers[0], medium).system(2, {0, 4});
        EXPECT_LT((coupled.g - coupled.g.transpose()).cwiseAbs().maxCoeff(), 1e-12);
    }
}

TEST(Nodes, IntegrateEveryHemisphereAndKeepFlux) {
    const Problem problem{
        1.0, {{1.0, 1.0, physical_expansion(3), 1.5}, {1.0, 1.0, physical_expansion(3), 1.33}}, BlackBase{}};
    const auto rays = quadrature_rays(problem, 12);
    for (double n : {1.0, 1.33, 1.5}) {
        const Medium medium = medium_of(rays, n);
        double flux = 0.0, solid = 0.0;
        for (int i = 0; i < medium.size(); ++i) {
            flux += medium.weight(i) * medium.mu[i];
            solid += medium.weight(i);
        }
        EXPECT_NEAR(flux, 0.5, 1e-14) << n;  // polynomials of degree 1 in each segment's own cosine
        EXPECT_NEAR(solid, 1.0, 1e-9) << n;  // mu of another medium, analytic: converges as 5^(-2N)
    }
}

TEST(Nodes, WignerTableMatchesTheFunction) {
    const Eigen::Vector3d mu(1e-6, 0.4, 1.0);
    for (auto [m, n] : {std::pair{0, 0}, {0, 2}, {1, -2}, {2, 2}, {7, 0}, {9, -2}}) {
        const Eigen::MatrixXd table = wigner_d_table(20, m, n, mu);
        for (int i = 0; i < 3; ++i) {
            const auto d = math::wigner_d(20, m, n, mu[i]);
            for (int l = 0; l <= 20; ++l) EXPECT_NEAR(table(i, l), d[l], 1e-13);
        }
    }
}

}  // namespace
}  // namespace patina::rt
