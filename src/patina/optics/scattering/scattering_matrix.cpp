#include "patina/optics/scattering/scattering_matrix.h"

#include <algorithm>
#include <cmath>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/optics/scattering/mie.h"

namespace patina::optics {

namespace {

using Complex = std::complex<double>;

// The multipoles of a few spheres as real matrices, so that sums over multipoles become matrix products. Columns (Re,
// Im) of c_n (a_n + b_n) and c_n (a_n - b_n), c_n = (2n+1)/(n(n+1)), and the same with the parity (-1)^(n+1) of pi_n +
// tau_n turning into pi_n - tau_n at -mu.
struct Batch {
    int order;
    // with `sum`: a+b, then (a-b) parity; with `difference`: a-b, then (a+b) parity. shape [order][4 spheres]
    Eigen::MatrixXd with_sum, with_difference;
};

Batch make_batch(const std::vector<MieSphere>& spheres) {
    Batch batch{0, {}, {}};
    for (const MieSphere& sphere : spheres) batch.order = std::max(batch.order, sphere.order());
    const auto columns = static_cast<Eigen::Index>(4 * spheres.size());
    batch.with_sum = Eigen::MatrixXd::Zero(batch.order, columns);
    batch.with_difference = Eigen::MatrixXd::Zero(batch.order, columns);
    for (std::size_t k = 0; k < spheres.size(); ++k) {
        for (int n = 1; n <= spheres[k].order(); ++n) {
            const double factor = (2.0 * n + 1) / (n * (n + 1.0));
            const double parity = n % 2 == 1 ? factor : -factor;
            const Complex a = spheres[k].a()[n - 1], b = spheres[k].b()[n - 1];
            const Complex sum = a + b, difference = a - b;
            const auto c = static_cast<Eigen::Index>(4 * k);
            batch.with_sum(n - 1, c) = factor * sum.real();
            batch.with_sum(n - 1, c + 1) = factor * sum.imag();
            batch.with_sum(n - 1, c + 2) = parity * difference.real();
            batch.with_sum(n - 1, c + 3) = parity * difference.imag();
            batch.with_difference(n - 1, c) = factor * difference.real();
            batch.with_difference(n - 1, c + 1) = factor * difference.imag();
            batch.with_difference(n - 1, c + 2) = parity * sum.real();
            batch.with_difference(n - 1, c + 3) = parity * sum.imag();
        }
    }
    return batch;
}

// Adds weight * (S11, S12, S33, S34) given S+- = S1 +- S2.
template <class Column>
void add_elements(Eigen::Ref<Eigen::ArrayX4d> rows, double weight, const Column& plus_re, const Column& plus_im,
                  const Column& minus_re, const Column& minus_im) {
    const auto pr = plus_re.array(), pi_ = plus_im.array(), mr = minus_re.array(), mi = minus_im.array();
    const double quarter = 0.25 * weight, half = 0.5 * weight;
    rows.col(0) += quarter * (pr * pr + pi_ * pi_ + mr * mr + mi * mi);
    rows.col(1) -= half * (pr * mr + pi_ * mi);
    rows.col(2) += quarter * (pr * pr + pi_ * pi_ - mr * mr - mi * mi);
    rows.col(3) += half * (pi_ * mr - pr * mi);
}

void add_batch(const std::vector<MieSphere>& spheres, std::span<const double> weights, std::span<const double> cosines,
               Eigen::ArrayX4d& elements) {
    const Batch batch = make_batch(spheres);
    const auto half = static_cast<Eigen::Index>(cosines.size());
    constexpr Eigen::Index block = 128;
    for (Eigen::Index begin = 0; begin < half; begin += block) {
        const Eigen::Index count = std::min(block, half - begin);
        const MieAngularFunctions f = mie_angular_functions(cosines.subspan(begin, count), batch.order);

        // Columns of a sphere: S+(mu) and S-(-mu) with the sum, S-(mu) and S+(-mu) with the difference.
        const Eigen::MatrixXd p = f.sum * batch.with_sum;
        const Eigen::MatrixXd q = f.difference * batch.with_difference;
        for (std::size_t k = 0; k < spheres.size(); ++k) {
            const auto c = static_cast<Eigen::Index>(4 * k);
            add_elements(elements.middleRows(begin, count), weights[k], p.col(c), p.col(c + 1), q.col(c), q.col(c + 1));
            add_elements(elements.middleRows(half + begin, count), weights[k], q.col(c + 2), q.col(c + 3), p.col(c + 2),
                         p.col(c + 3));
        }
    }
}

}  // namespace

double normalize(ScatteringMatrix& matrix) {
    const Eigen::Map<const Eigen::ArrayXd> w(matrix.cosines.weights.data(), matrix.cosines.size());
    const double integral = 0.5 * (w * matrix.a1).sum();
    PATINA_EXPECT(integral > 0.0);
    for (Eigen::ArrayXd* element : {&matrix.a1, &matrix.a2, &matrix.a3, &matrix.a4, &matrix.b1, &matrix.b2})
        *element /= integral;
    return integral;
}

SphereSums& SphereSums::operator+=(const SphereSums& other) {
    number += other.number;
    radius2_um2 += other.radius2_um2;
    radius3_um3 += other.radius3_um3;
    extinction_um2 += other.extinction_um2;
    scattering_um2 += other.scattering_um2;
    absorption_um2 += other.absorption_um2;
    elements += other.elements;
    return *this;
}

int matrix_nodes(double size_parameter) {
    // F is a polynomial of twice the order of the multipoles; Wiscombe's (1980) count of them carries all but 1e-8 of
    // it.
    return 2 * static_cast<int>(size_parameter + 4.05 * std::cbrt(size_parameter) + 2.0) + 2;
}

SphereSums sum_spheres(Complex relative_index, Complex wavenumber_per_um, std::span<const double> radii_um,
                       std::span<const double> weights, const math::Quadrature& cosines) {
    PATINA_EXPECT(cosines.size() % 2 == 0 && radii_um.size() == weights.size());
    SphereSums sums;
    sums.elements = Eigen::ArrayX4d::Zero(cosines.size(), 4);
    const std::span<const double> positive = std::span(cosines.nodes).subspan(cosines.size() / 2);

    constexpr std::size_t batch = 32;
    std::vector<MieSphere> spheres;
    for (std::size_t begin = 0; begin < radii_um.size(); begin += batch) {
        spheres.clear();
        const std::size_t end = std::min(begin + batch, radii_um.size());
        for (std::size_t i = begin; i < end; ++i) {
            const double r = radii_um[i], r2 = r * r, area = pi * r2;
            const MieSphere& sphere = spheres.emplace_back(
                wavenumber_per_um.imag() > 0.0 ? MieSphere::in_absorbing_host(wavenumber_per_um * r, relative_index)
                                               : MieSphere(wavenumber_per_um.real() * r, relative_index));
            sums.number += weights[i];
            sums.radius2_um2 += weights[i] * r2;
            sums.radius3_um3 += weights[i] * r2 * r;
            sums.extinction_um2 += weights[i] * area * sphere.extinction_efficiency();
            sums.scattering_um2 += weights[i] * area * sphere.scattering_efficiency();
            sums.absorption_um2 += weights[i] * area * sphere.absorption_efficiency();
        }
        add_batch(spheres, weights.subspan(begin, end - begin), positive, sums.elements);
    }
    return sums;
}

ScatteringMatrix scattering_matrix(const SphereSums& sums, const math::Quadrature& cosines) {
    const Eigen::Index count = cosines.size(), half = count / 2;
    ScatteringMatrix matrix;
    matrix.cosines = cosines;
    const auto ascending = [&](int element) {
        Eigen::ArrayXd values(count);
        values << sums.elements.col(element).tail(half).reverse(), sums.elements.col(element).head(half);
        return values;
    };
    matrix.a1 = matrix.a2 = ascending(0);
    matrix.b1 = ascending(1);
    matrix.a3 = matrix.a4 = ascending(2);
    matrix.b2 = ascending(3);
    normalize(matrix);
    return matrix;
}

}  // namespace patina::optics
