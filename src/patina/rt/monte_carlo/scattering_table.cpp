#include "patina/rt/monte_carlo/scattering_table.h"

#include "patina/core/contract.h"

namespace patina::rt::monte_carlo {

namespace {

// P^(a,b)_n(x) for n = 0, 1, 2, ...: value() then advance() (Abramowitz & Stegun 1964, 22.7.1).
class JacobiRecurrence {
  public:
    JacobiRecurrence(double a, double b, double x) : a_(a), b_(b), x_(x) {}
    double value() const { return current_; }
    void advance() {
        const double n = n_, s = 2.0 * n + a_ + b_;
        double next;
        if (n_ == 0) {
            next = 0.5 * (a_ - b_ + (a_ + b_ + 2.0) * x_);
        } else {
            next = ((s + 1.0) * (a_ * a_ - b_ * b_ + (s + 2.0) * s * x_) * current_ -
                    2.0 * (n + a_) * (n + b_) * (s + 2.0) * previous_) /
                   (2.0 * (n + 1.0) * (n + a_ + b_ + 1.0) * s);
        }
        previous_ = current_;
        current_ = next;
        ++n_;
    }

  private:
    double a_, b_, x_;
    int n_ = 0;
    double previous_ = 0.0, current_ = 1.0;
};

double node_cosine(int node, int cells) {
    const double u = static_cast<double>(node) / cells;
    return 1.0 - u * u;
}

}  // namespace

ScatteringElements sum_expansion(const optics::ExpansionCoefficients& c, double x) {
    // P_l'' is a Jacobi polynomial too: P_l'' = (l+1)(l+2)/4 P^(2,2)_{l-2}.
    JacobiRecurrence legendre(0, 0, x), second(2, 2, x), plus(0, 4, x), minus(4, 0, x);
    double a1 = 0, a4 = 0, b1 = 0, b2 = 0, sum23 = 0, difference23 = 0;
    for (int l = 0; l <= c.order(); ++l, legendre.advance()) {
        const std::size_t i = static_cast<std::size_t>(l);
        a1 += c.alpha1[i] * legendre.value();
        a4 += c.alpha4[i] * legendre.value();
        if (l < 2) continue;
        const double d02 = 0.25 * std::sqrt((l + 1.0) * (l + 2.0) / (l * (l - 1.0))) * (1.0 - x * x) * second.value();
        b1 -= c.beta1[i] * d02;
        b2 -= c.beta2[i] * d02;
        sum23 += (c.alpha2[i] + c.alpha3[i]) * 0.25 * (1.0 + x) * (1.0 + x) * plus.value();
        difference23 += (c.alpha2[i] - c.alpha3[i]) * 0.25 * (1.0 - x) * (1.0 - x) * minus.value();
        second.advance();
        plus.advance();
        minus.advance();
    }
    return {a1, 0.5 * (sum23 + difference23), 0.5 * (sum23 - difference23), a4, b1, b2, std::max(a1, 0.0)};
}

ScatteringTable::ScatteringTable(const optics::ExpansionCoefficients& coefficients, bool scalar)
    : cells_(std::clamp(128 * (coefficients.order() + 1), 2048, 65536)) {
    // Tabulate both hemispheres, each from its pole to the equator.
    nodes_.resize(2 * static_cast<std::size_t>(cells_ + 1));
    for (int i = 0; i <= cells_; ++i)
        for (int half : {0, 1}) {
            const double x = (half == 0 ? 1.0 : -1.0) * node_cosine(i, cells_);
            ScatteringElements f = sum_expansion(coefficients, x);
            if (scalar) f = {f.a1, 0, 0, 0, 0, 0, f.density};
            f.density = std::max(f.density, 1e-3 * std::abs(f.a1) + 1e-9);
            static_cast<ScatteringElements&>(nodes_[static_cast<std::size_t>(half * (cells_ + 1) + i)]) = f;
        }
    normalize_and_build_alias();
}

void ScatteringTable::normalize_and_build_alias() {
    // Integrate the piecewise linear interpolants exactly.
    std::vector<double> probability(2 * static_cast<std::size_t>(cells_));
    double norm = 0.0, mass = 0.0;
    for (int cell = 0; cell < 2 * cells_; ++cell) {
        const int i = cell % cells_;
        const std::size_t node = static_cast<std::size_t>(cell + (cell >= cells_));
        const double width = node_cosine(i, cells_) - node_cosine(i + 1, cells_);
        norm += 0.25 * width * (nodes_[node].a1 + nodes_[node + 1].a1);
        probability[static_cast<std::size_t>(cell)] = 0.25 * width * (nodes_[node].density + nodes_[node + 1].density);
        mass += probability[static_cast<std::size_t>(cell)];
    }
    PATINA_EXPECT(norm > 0.5 && norm < 2.0);  // alpha1[0] = 1

    // Make the table conserve energy exactly: (1/2) int a1 dcos = 1, and the density integrate to 1.
    for (Node& f : nodes_) {
        for (double* element : {&f.a1, &f.a2, &f.a3, &f.a4, &f.b1, &f.b2}) *element /= norm;
        f.density /= mass;
    }

    // Pair poor cells with rich ones (Walker 1977; Vose 1991).
    const std::size_t count = probability.size();
    alias_.assign(count, {1.0, 0});
    std::vector<std::int32_t> poor, rich;
    for (std::size_t i = 0; i < count; ++i) {
        probability[i] *= static_cast<double>(count) / mass;
        (probability[i] < 1.0 ? poor : rich).push_back(static_cast<std::int32_t>(i));
    }
    while (!poor.empty() && !rich.empty()) {
        const std::int32_t small = poor.back(), large = rich.back();
        poor.pop_back();
        alias_[static_cast<std::size_t>(small)] = {probability[static_cast<std::size_t>(small)], large};
        double& left = probability[static_cast<std::size_t>(large)];
        left -= 1.0 - probability[static_cast<std::size_t>(small)];
        if (left < 1.0) {
            rich.pop_back();
            poor.push_back(large);
        }
    }
}

double ScatteringTable::sample_cosine(RandomStream& random) const {
    // Choose the cell.
    const double scaled = random.uniform() * static_cast<double>(alias_.size());
    int cell = std::min(static_cast<int>(scaled), 2 * cells_ - 1);
    if (scaled - cell >= alias_[static_cast<std::size_t>(cell)].threshold)
        cell = alias_[static_cast<std::size_t>(cell)].other;

    // Invert the linear density inside it; the form without cancellation of the root of f t + (g - f) t^2 / 2 = xi (f +
    // g)/2.
    const std::size_t node = static_cast<std::size_t>(cell + (cell >= cells_));
    const double f = nodes_[node].density, g = nodes_[node + 1].density, xi = random.uniform();
    const double t = xi * (f + g) / (f + std::sqrt(f * f + xi * (g * g - f * f)));
    const int i = cell % cells_;
    const double x = 1.0 - (static_cast<double>(i) * i + t * (2.0 * i + 1.0)) / (static_cast<double>(cells_) * cells_);
    return cell < cells_ ? x : -x;
}

}  // namespace patina::rt::monte_carlo
