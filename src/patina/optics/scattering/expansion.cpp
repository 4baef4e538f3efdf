#include "patina/optics/scattering/expansion.h"

#include <algorithm>
#include <cmath>

#include "patina/core/constants.h"
#include "patina/core/contract.h"

namespace patina::optics {

namespace {

using Eigen::ArrayXd;

// d^l_00, d^l_02, d^l_22, d^l_2,-2 at many cosines, l ascending (the recurrence of math/wigner_d.h, all angles at
// once).
class WignerColumns {
  public:
    explicit WignerColumns(const ArrayXd& cosines)
        : x_(cosines),
          d00_(ArrayXd::Ones(x_.size())),
          d02_(ArrayXd::Zero(x_.size())),
          d22_(d02_),
          d2m2_(d02_),
          d00_previous_(d02_),
          d02_previous_(d02_),
          d22_previous_(d02_),
          d2m2_previous_(d02_) {}

    const ArrayXd& d00() const { return d00_; }
    const ArrayXd& d02() const { return d02_; }
    const ArrayXd& d22() const { return d22_; }
    const ArrayXd& d2m2() const { return d2m2_; }

    // From degree l to l + 1.
    void advance() {
        const double l = degree_++, next = l + 1.0;
        step(d00_, d00_previous_, (2 * l + 1) / next, 0.0, l / next);
        if (degree_ == 2) {
            d02_ = std::sqrt(6.0) / 4.0 * (1.0 - x_.square());
            d22_ = 0.25 * (1.0 + x_).square();
            d2m2_ = 0.25 * (1.0 - x_).square();
        } else if (degree_ > 2) {
            const double up = std::sqrt(next * next - 4.0), down = std::sqrt(l * l - 4.0);
            step(d02_, d02_previous_, (2 * l + 1) / up, 0.0, down / up);
            const double scale = (2 * l + 1) / (l * up * up);
            const double back = next * down * down / (l * up * up);
            step(d22_, d22_previous_, scale * l * next, -4.0 * scale, back);
            step(d2m2_, d2m2_previous_, scale * l * next, 4.0 * scale, back);
        }
    }

  private:
    // d <- (slope x + offset) d - back d_previous.
    void step(ArrayXd& d, ArrayXd& previous, double slope, double offset, double back) {
        previous = (slope * x_ + offset) * d - back * previous;
        std::swap(d, previous);
    }

    int degree_ = 0;
    ArrayXd x_;
    ArrayXd d00_, d02_, d22_, d2m2_, d00_previous_, d02_previous_, d22_previous_, d2m2_previous_;
};

void resize(ExpansionCoefficients& c, int count) {
    for (std::vector<double>* list : {&c.alpha1, &c.alpha2, &c.alpha3, &c.alpha4, &c.beta1, &c.beta2})
        list->resize(count, 0.0);
}

}  // namespace

ExpansionCoefficients expand(const ScatteringMatrix& matrix, double tolerance) {
    PATINA_EXPECT(matrix.cosines.size() >= 4 && matrix.a1.size() == matrix.cosines.size());
    const int nodes = matrix.cosines.size();
    const Eigen::Map<const ArrayXd> x(matrix.cosines.nodes.data(), nodes), w(matrix.cosines.weights.data(), nodes);
    const ArrayXd a1 = w * matrix.a1, a4 = w * matrix.a4, b1 = w * matrix.b1, b2 = w * matrix.b2;
    const ArrayXd sum = w * (matrix.a2 + matrix.a3), difference = w * (matrix.a2 - matrix.a3);

    ExpansionCoefficients c;
    resize(c, nodes);
    WignerColumns d(x);
    for (int l = 0; l < nodes; ++l, d.advance()) {
        // int d^l_mn d^l'_mn dx = 2/(2l+1) delta_ll'.
        const double factor = 0.5 * (2 * l + 1);
        const double s = factor * (sum * d.d22()).sum(), t = factor * (difference * d.d2m2()).sum();
        c.alpha1[l] = factor * (a1 * d.d00()).sum();
        c.alpha2[l] = 0.5 * (s + t);
        c.alpha3[l] = 0.5 * (s - t);
        c.alpha4[l] = factor * (a4 * d.d00()).sum();
        c.beta1[l] = -factor * (b1 * d.d02()).sum();
        c.beta2[l] = -factor * (b2 * d.d02()).sum();
    }
    truncate(c, tolerance);
    return c;
}

ScatteringElements evaluate(const ExpansionCoefficients& c, double cosine) {
    PATINA_EXPECT(cosine >= -1.0 && cosine <= 1.0);
    const ScatteringMatrix f = evaluate(c, math::Quadrature{{cosine}, {2.0}});
    return {f.a1[0], f.a2[0], f.a3[0], f.a4[0], f.b1[0], f.b2[0]};
}

ScatteringMatrix evaluate(const ExpansionCoefficients& c, const math::Quadrature& cosines) {
    const ArrayXd x = Eigen::Map<const ArrayXd>(cosines.nodes.data(), cosines.size());
    ScatteringMatrix f;
    f.cosines = cosines;
    for (ArrayXd* element : {&f.a1, &f.a2, &f.a3, &f.a4, &f.b1, &f.b2}) *element = ArrayXd::Zero(x.size());
    ArrayXd sum = f.a1, difference = f.a1;
    WignerColumns d(x);
    for (int l = 0; l <= c.order(); ++l, d.advance()) {
        f.a1 += c.alpha1[l] * d.d00();
        f.a4 += c.alpha4[l] * d.d00();
        sum += (c.alpha2[l] + c.alpha3[l]) * d.d22();
        difference += (c.alpha2[l] - c.alpha3[l]) * d.d2m2();
        f.b1 -= c.beta1[l] * d.d02();
        f.b2 -= c.beta2[l] * d.d02();
    }
    f.a2 = 0.5 * (sum + difference);
    f.a3 = 0.5 * (sum - difference);
    return f;
}

StokesCriterion stokes_criterion(const ExpansionCoefficients& coefficients) {
    // About four angles to a swing of the highest order, as far as that can be afforded.
    const int intervals = std::clamp(4 * coefficients.order(), 64, 1024);
    math::Quadrature angles;
    for (int i = 0; i <= intervals; ++i) angles.nodes.push_back(-std::cos(pi * i / intervals));
    angles.weights.assign(angles.nodes.size(), 0.0);
    const ScatteringMatrix f = evaluate(coefficients, angles);

    // Incident light is (1, q, U, V) with U^2 + V^2 = 1 - q^2; the block of U and V lengthens these by at most its
    // larger singular value.
    const ArrayXd half_sum = 0.5 * (f.a3 + f.a4), half_difference = 0.5 * (f.a3 - f.a4);
    const ArrayXd stretch = (half_sum.square() + f.b2.square()).sqrt() + half_difference.abs();
    ArrayXd excess = ArrayXd::Zero(intervals + 1);
    constexpr int steps = 10;
    for (int k = -steps; k <= steps; ++k) {
        const double q = static_cast<double>(k) / steps;
        const ArrayXd polarized = ((f.b1 + q * f.a2).square() + (1.0 - q * q) * stretch.square()).sqrt();
        excess = excess.max(polarized - (f.a1 + q * f.b1));
    }
    Eigen::Index where = 0;
    const double largest = excess.maxCoeff(&where);
    return {largest, 180.0 - 180.0 * static_cast<double>(where) / intervals, f.a1.maxCoeff()};
}

void add(ExpansionCoefficients& sum, const ExpansionCoefficients& term, double weight) {
    using Member = std::vector<double> ExpansionCoefficients::*;
    for (const Member member :
         {&ExpansionCoefficients::alpha1, &ExpansionCoefficients::alpha2, &ExpansionCoefficients::alpha3,
          &ExpansionCoefficients::alpha4, &ExpansionCoefficients::beta1, &ExpansionCoefficients::beta2}) {
        std::vector<double>& target = sum.*member;
        const std::vector<double>& source = term.*member;
        if (target.size() < source.size()) target.resize(source.size(), 0.0);
        for (std::size_t l = 0; l < source.size(); ++l) target[l] += weight * source[l];
    }
}

void truncate(ExpansionCoefficients& c, double tolerance) {
    int order = c.order();
    const auto matters = [&](int l) {
        return std::max({std::abs(c.alpha1[l]), std::abs(c.alpha2[l]), std::abs(c.alpha3[l]), std::abs(c.alpha4[l]),
                         std::abs(c.beta1[l]), std::abs(c.beta2[l])}) >= tolerance;
    };
    while (order > 2 && !matters(order)) --order;
    resize(c, std::max(order, 2) + 1);
}

}  // namespace patina::optics
