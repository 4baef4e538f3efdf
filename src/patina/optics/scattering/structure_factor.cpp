#include "patina/optics/scattering/structure_factor.h"

#include <cmath>

#include "patina/core/contract.h"

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

}  // namespace

double percus_yevick(double f, double x) {
    PATINA_EXPECT(f >= 0.0 && f <= max_packing_fraction && x >= 0.0);
    const double fourth_power = std::pow(1.0 - f, 4);
    const double alpha = (1 + 2 * f) * (1 + 2 * f) / fourth_power;
    const double beta = -6 * f * (1 + 0.5 * f) * (1 + 0.5 * f) / fourth_power;
    return 1.0 / (1.0 + 24.0 * f * direct_correlation(alpha, beta, 0.5 * f * alpha, x));
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
