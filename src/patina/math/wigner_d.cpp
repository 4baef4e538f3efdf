#include "patina/math/wigner_d.h"

#include <cmath>
#include <cstdlib>

#include "patina/core/contract.h"

namespace patina::math {

namespace {

// d^s_mn at s = max(|m|,|n|) (op. cit. eqs B.24-B.25), through logarithms so that large orders do not overflow.
double starting_value(int s, int m, int n, double x) {
    const int difference = std::abs(m - n);
    const int sum = std::abs(m + n);
    const double sign = (n >= m || (m - n) % 2 == 0) ? 1.0 : -1.0;
    const double log_binomial =
        0.5 * (std::lgamma(2.0 * s + 1) - std::lgamma(difference + 1.0) - std::lgamma(sum + 1.0)) - s * std::log(2.0);
    return sign * std::exp(log_binomial) * std::pow(1.0 - x, 0.5 * difference) * std::pow(1.0 + x, 0.5 * sum);
}

}  // namespace

std::vector<double> wigner_d(int order, int m, int n, double x) {
    PATINA_EXPECT(order >= 0 && x >= -1.0 && x <= 1.0);
    std::vector<double> d(order + 1, 0.0);
    const int start = std::max(std::abs(m), std::abs(n));
    if (order < start) return d;

    d[start] = starting_value(start, m, n, x);
    for (int l = start; l < order; ++l) {
        if (l == 0) {
            d[1] = x;
            continue;
        }
        // op. cit. eq. B.22; the term of d^{l-1} vanishes by itself at l = start.
        const double ls = static_cast<double>(l);
        const double lp = ls + 1.0;
        const double normalisation = ls * std::sqrt((lp * lp - m * m) * (lp * lp - n * n));
        const double previous = l > start ? lp * std::sqrt((ls * ls - m * m) * (ls * ls - n * n)) * d[l - 1] : 0.0;
        d[l + 1] = ((2 * ls + 1) * (ls * lp * x - m * n) * d[l] - previous) / normalisation;
    }
    return d;
}

}  // namespace patina::math
