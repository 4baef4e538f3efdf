#include "patina/math/quadrature.h"

#include <cmath>

#include "patina/core/constants.h"
#include "patina/core/contract.h"

namespace patina::math {

namespace {

struct LegendreValue {
    double value;
    double derivative;
};

// P_n(x) and P_n'(x) by the three-term recurrence; |x| < 1.
LegendreValue legendre(int n, double x) {
    double previous = 1.0;
    double current = x;
    for (int l = 2; l <= n; ++l) {
        const double next = ((2 * l - 1) * x * current - (l - 1) * previous) / l;
        previous = current;
        current = next;
    }
    return {current, n * (previous - x * current) / (1.0 - x * x)};
}

}  // namespace

Quadrature gauss_legendre(int n, double lower, double upper) {
    PATINA_EXPECT(n >= 1 && upper > lower);
    Quadrature rule{std::vector<double>(n), std::vector<double>(n)};
    const double centre = 0.5 * (lower + upper);
    const double half_width = 0.5 * (upper - lower);
    if (n == 1) return {{centre}, {upper - lower}};

    for (int i = 0; i < (n + 1) / 2; ++i) {
        // Find the i-th largest root.
        double x = std::cos(pi * (i + 0.75) / (n + 0.5));
        if (n % 2 == 1 && i == n / 2) x = 0.0;
        for (int iteration = 0; iteration < 100; ++iteration) {
            const LegendreValue p = legendre(n, x);
            const double step = p.value / p.derivative;
            x -= step;
            if (std::abs(step) < 1e-16) break;
        }
        const double derivative = legendre(n, x).derivative;
        const double weight = 2.0 / ((1.0 - x * x) * derivative * derivative);

        // Place it and its mirror image.
        rule.nodes[n - 1 - i] = centre + half_width * x;
        rule.nodes[i] = centre - half_width * x;
        rule.weights[n - 1 - i] = rule.weights[i] = half_width * weight;
    }
    return rule;
}

}  // namespace patina::math
