#include "patina/rt/balance.h"

#include <algorithm>
#include <cmath>

namespace patina::rt {

Eigen::VectorXd balance(const Eigen::MatrixXd& b, const Eigen::VectorXd& target, const std::vector<Role>& roles) {
    constexpr int most_steps = 10000;
    const Eigen::Index count = b.cols();
    Eigen::VectorXd c = Eigen::VectorXd::Ones(count), weight(count);
    for (Eigen::Index i = 0; i < count; ++i) weight[i] = roles[i] == Role::quadrature ? 1.0 : 0.0;
    const auto step = [&](Eigen::VectorXd& next) {
        next.noalias() = b.transpose() * c.cwiseProduct(weight);
        for (Eigen::Index i = 0; i < count; ++i)
            next[i] = next[i] > 1e-12 * target[i] && target[i] > 0.0 ? target[i] / next[i] : 1.0;
    };

    // The geometric mean of two steps damps the alternation that plain steps would have.
    Eigen::VectorXd next(count);
    for (int i = 0; i < most_steps; ++i) {
        step(next);
        double change = 0.0;
        for (Eigen::Index k = 0; k < count; ++k) {
            if (weight[k] > 0.0) change = std::max(change, std::abs(next[k] / c[k] - 1.0));
            c[k] = weight[k] > 0.0 ? std::sqrt(c[k] * next[k]) : next[k];
        }
        if (change < 1e-15) break;
    }
    step(next);
    for (Eigen::Index k = 0; k < count; ++k)
        if (weight[k] == 0.0) c[k] = next[k];
    return c;
}

double largest_correction(const Eigen::VectorXd& factors, const Medium& medium) {
    double worst = 0.0;
    for (int i = 0; i < medium.size(); ++i)
        if (medium.roles[i] == Role::quadrature && medium.mu[i] > 0.5)
            worst = std::max(worst, std::abs(factors[i] * factors[i] - 1.0));
    return worst;
}

}  // namespace patina::rt
