#include "patina/math/quadrature.h"
#include "patina/math/wigner_d.h"

namespace patina::math {
namespace {

TEST(Quadrature, IntegratesPolynomialsOfDegree2nMinus1Exactly) {
    for (int n : {1, 2, 3, 8, 33, 200}) {
        const Quadrature rule = gauss_legendre(n, 0.0, 1.0);
        for (int degree : {0, 1, 2 * n - 1}) {
            double sum = 0.0;
            for (int i = 0; i < n; ++i) sum += rule.weights[i] * std::pow(rule.nodes[i], degree);
            EXPECT_NEAR(sum, 1.0 / (degree + 1), 1e-14) << n << " points, degree " << degree;
        }
    }
}

TEST(WignerD, MatchesTheClosedFormsOfDegreeTwo) {
    for (double x : {-1.0, -0.7, 0.0, 0.3, 1.0}) {
        EXPECT_NEAR(wigner_d(2, 0, 0, x)[2], 1.5 * x * x - 0.5, 1e-15);
        EXPECT_NEAR(wigner_d(2, 2, 0, x)[2], std::sqrt(6.0) / 4 * (1 - x * x), 1e-15);
        EXPECT_NEAR(wigner_d(2, 0, 2, x)[2], std::sqrt(6.0) / 4 * (1 - x * x), 1e-15);
        EXPECT_NEAR(wigner_d(2, 2, 2, x)[2], 0.25 * (1 + x) * (1 + x), 1e-15);
        EXPECT_NEAR(wigner_d(2, 2, -2, x)[2], 0.25 * (1 - x) * (1 - x), 1e-15);
        EXPECT_NEAR(wigner_d(2, 1, 2, x)[2], 0.5 * (1 + x) * std::sqrt(1 - x * x), 1e-15);
        EXPECT_NEAR(wigner_d(2, 2, 1, x)[2], -0.5 * (1 + x) * std::sqrt(1 - x * x), 1e-15);
    }
}

// int d^l_mn d^l'_mn dx = 2/(2l+1) delta_ll' (op. cit. eq. B.32).
TEST(WignerD, IsOrthogonal) {
    const Quadrature rule = gauss_legendre(40);
    for (auto [m, n] : {std::pair{0, 0}, {0, 2}, {2, 2}, {2, -2}, {5, 2}, {7, -2}, {7, 0}}) {
        Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(31, 31);
        for (int i = 0; i < rule.size(); ++i) {
            const std::vector<double> d = wigner_d(30, m, n, rule.nodes[i]);
            const Eigen::Map<const Eigen::VectorXd> v(d.data(), 31);
            gram += rule.weights[i] * v * v.transpose();
        }
        for (int l = 0; l <= 30; ++l)
            for (int k = 0; k <= 30; ++k) {
                const double expected = (l == k && l >= std::max(std::abs(m), std::abs(n))) ? 2.0 / (2 * l + 1) : 0.0;
                EXPECT_NEAR(gram(l, k), expected, 1e-13) << m << " " << n << " " << l << " " << k;
            }
    }
}

}  // namespace
}  // namespace patina::math
