#include "patina/optics/scattering/structure_factor.h"

#include <cmath>
#include <complex>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/optics/scattering/expansion.h"

namespace patina::optics {

namespace {

// int_0^1 s^p sin(x s)/(x s) s^2 ds summed with the coefficients of s^0, s^1, s^3: the closed form cancels as x -> 0,
// its series not.
double direct_correlation(double alpha, double beta, double gamma, double x) {
    const double x2 = x * x;
    if (x < 2.0) {
        double sum = 0.0, term = 1.0;  // (-1)^k x^2k / (2k+1)!
        for (int k = 0; k < 14; ++k) {
            sum += term * (alpha / (2 * k + 3) + beta / (2 * k + 4) + gamma / (2 * k + 6));
            term *= -x2 / ((2 * k + 2) * (2 * k + 3));
        }
        return sum;
    }
    const double sine = std::sin(x), cosine = std::cos(x);
    const double g =
        alpha * (sine - x * cosine) / x2 + beta * (2 * x * sine + (2 - x2) * cosine - 2) / (x2 * x) +
        gamma * (-x2 * x2 * cosine + 4 * ((3 * x2 - 6) * cosine + (x2 * x - 6 * x) * sine + 6)) / (x2 * x2 * x);
    return g / x;
}

// j1(u)/u of the spherical Bessel function; the closed form cancels as u -> 0.
double bessel_1_over(double u) {
    if (u < 0.05) return 1.0 / 3.0 - u * u / 30.0 + u * u * u * u / 840.0;
    return (std::sin(u) - u * std::cos(u)) / (u * u * u);
}

}  // namespace

double percus_yevick(double f, double x) {
    PATINA_EXPECT(f >= 0.0 && f <= max_packing_fraction && x >= 0.0);
    const double fourth_power = std::pow(1.0 - f, 4);
    const double alpha = (1 + 2 * f) * (1 + 2 * f) / fourth_power;
    const double beta = -6 * f * (1 + 0.5 * f) * (1 + 0.5 * f) / fourth_power;
    return 1.0 / (1.0 + 24.0 * f * direct_correlation(alpha, beta, 0.5 * f * alpha, x));
}

Eigen::MatrixXd percus_yevick_mixture(std::span<const double> diameters, std::span<const double> number_densities,
                                      double q) {
    using Complex = std::complex<double>;
    PATINA_EXPECT(diameters.size() == number_densities.size() && q >= 0.0);
    const auto count = static_cast<Eigen::Index>(diameters.size());
    double xi2 = 0.0, xi3 = 0.0;  // pi/6 sum n d^2 and the volume fraction
    for (Eigen::Index i = 0; i < count; ++i) {
        xi2 += pi / 6.0 * number_densities[i] * std::pow(diameters[i], 2);
        xi3 += pi / 6.0 * number_densities[i] * std::pow(diameters[i], 3);
    }
    PATINA_EXPECT(xi3 <= max_packing_fraction * (1.0 + 1e-12));

    // Baxter's factor function is Q_ij(r) = a_i (r^2 - R^2)/2 + b_i (r - R) from r = (d_i - d_j)/2 to R = (d_i +
    // d_j)/2. With r = d_i/2 + t its transform is exp(i q d_i/2) times integrals of t - s and t^2 - s^2 from -s to s =
    // d_j/2.
    const double free = 1.0 - xi3;
    Eigen::MatrixXcd factor = Eigen::MatrixXcd::Identity(count, count);
    for (Eigen::Index j = 0; j < count; ++j) {
        const double s = 0.5 * diameters[j], u = q * s, j1_over_u = bessel_1_over(u);
        const double j0 = u > 0.0 ? std::sin(u) / u : 1.0;
        const double square = -4.0 * s * s * s * j1_over_u;
        const Complex linear = 2.0 * s * s * Complex(-j0, u * j1_over_u);
        for (Eigen::Index i = 0; i < count; ++i) {
            const double d = diameters[i];
            const double a = (free + 3.0 * d * xi2) / (free * free), b = -1.5 * d * d * xi2 / (free * free);
            factor(i, j) -= 2.0 * pi * std::sqrt(number_densities[i] * number_densities[j]) *
                            std::polar(1.0, 0.5 * q * d) * (0.5 * a * square + (0.5 * a * d + b) * linear);
        }
    }
    return (factor.adjoint() * factor).real().llt().solve(Eigen::MatrixXd::Identity(count, count));
}

ScatteringMatrix matrix_to_pack(const ExpansionCoefficients& expansion, const math::Quadrature& cosines) {
    ScatteringMatrix matrix = evaluate(expansion, cosines);
    if (matrix.a1.minCoeff() < -1e-3 * matrix.a1.maxCoeff())
        throw input_error({}, "an expansion whose a1 is negative in places cannot be packed", "",
                          "give more orders, or packing = \"independent\"");
    matrix.a1 = matrix.a1.max(0.0);
    return matrix;
}

double apply_structure_factor(ScatteringMatrix& matrix, double volume_fraction, double wavenumber_per_um,
                              double diameter_um) {
    for (int i = 0; i < matrix.cosines.size(); ++i) {
        const double q = 2.0 * wavenumber_per_um * std::sqrt(0.5 * (1.0 - matrix.cosines.nodes[i]));
        const double s = percus_yevick(volume_fraction, q * diameter_um);
        for (Eigen::ArrayXd* element : {&matrix.a1, &matrix.a2, &matrix.a3, &matrix.a4, &matrix.b1, &matrix.b2})
            (*element)[i] *= s;
    }
    return normalize(matrix);
}

}  // namespace patina::optics
