#include "patina/rt/kernel.h"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/math/wigner_d.h"

namespace patina::rt {

Eigen::MatrixXd wigner_d_table(int order, int m, int n, const Eigen::VectorXd& mu) {
    Eigen::MatrixXd d = Eigen::MatrixXd::Zero(mu.size(), order + 1);
    const int start = std::max(std::abs(m), std::abs(n));
    if (start > order) return d;
    for (Eigen::Index i = 0; i < mu.size(); ++i) d(i, start) = math::wigner_d(start, m, n, mu[i])[start];
    if (start == 0 && order >= 1) d.col(1) = mu;

    // Climb in l for all cosines at once (Mishchenko, Travis & Lacis 2002, eq. B.22).
    for (int l = std::max(start, 1); l < order; ++l) {
        const double a = l, b = l + 1.0, mm = double(m) * m, nn = double(n) * n;
        const double norm = a * std::sqrt((b * b - mm) * (b * b - nn));
        const double back = b * std::sqrt((a * a - mm) * (a * a - nn)) / norm;
        const double slope = (2 * a + 1) * a * b / norm, shift = (2 * a + 1) * double(m) * n / norm;
        d.col(l + 1) = (slope * mu.array() - shift) * d.col(l).array() - back * d.col(l - 1).array();
    }
    return d;
}

LayerKernel::LayerKernel(const Layer& layer, const Medium& medium) : layer_(layer), medium_(medium) {
    const auto& expansion = layer.expansion;
    const int order = expansion.order(), n = medium.size();
    const Eigen::MatrixXd p = wigner_d_table(order, 0, 0, medium.mu);
    const Eigen::MatrixXd r = -wigner_d_table(order, 0, 2, medium.mu);
    Eigen::VectorXd weights(n);
    for (int i = 0; i < n; ++i) weights[i] = medium.weight(i);

    // Find what the even degrees above 0 scatter out of an isotropic field; exact quadrature would give nothing.
    Eigen::VectorXd defect_i = Eigen::VectorXd::Zero(n), defect_q = Eigen::VectorXd::Zero(n);
    for (int l = 2; l <= order; l += 2) {
        const double mean = weights.dot(p.col(l));
        defect_i += expansion.alpha1[l] * mean * p.col(l);
        defect_q += expansion.beta1[l] * mean * r.col(l);
    }

    // Let degree 0 take it up: b_i sum_j w_j b_j + defect_i = 1.
    const double square = weights.dot((1.0 - defect_i.array()).matrix());
    if (!(square > 0.1))
        throw input_error(SourceLocation{}, "too few streams for the phase function",
                          fmt::format("its expansion of order {} does not integrate to 1 on {} nodes", order, n),
                          fmt::format("take {} streams", order / 2 + 1));
    const double total = std::sqrt(square);
    isotropic_i_ = (1.0 - defect_i.array()) / total;
    isotropic_q_ = -defect_q / total;
}

namespace {

struct WignerTables {
    WignerTables(int order, int m, const Eigen::VectorXd& mu) : p(wigner_d_table(order, m, 0, mu)) {
        const Eigen::MatrixXd plus = wigner_d_table(order, m, 2, mu), minus = wigner_d_table(order, m, -2, mu);
        r = -0.5 * (minus + plus);
        t = -0.5 * (minus - plus);
    }
    Eigen::MatrixXd p, r, t;
};

// Element (component, middle) of D_l at ray i.
double element(const WignerTables& d, int component, int middle, int i, int l) {
    if (component == 0 || component == 3) return component == middle ? d.p(i, l) : 0.0;
    if (middle == 0 || middle == 3) return 0.0;
    return component == middle ? d.r(i, l) : d.t(i, l);
}

// D_l of every ray and its product with the expansion matrix S_l, two columns a degree from l = m on.
struct DegreeFactors {
    Eigen::MatrixXd left, right;
    Eigen::Matrix2d first;  // the matrix of the first degree
};

// The sum over l splits: D_l(-u) = (-1)^(l+m) Delta D_l(u) Delta, so that degrees of even l + m reach H only through
// the (I,Q) part of their expansion matrix and G only through (U,V), and odd ones the other way round: `even` gives the
// factors of P H (with P S_l), else of G P (with S_l P).
DegreeFactors degree_factors(const WignerTables& d, const optics::ExpansionCoefficients& x, int m,
                             Components components, bool even) {
    const int order = x.order(), degrees = std::max(order + 1 - m, 0), nc = components.count;
    const int rays = static_cast<int>(d.p.rows());
    const double sign = even ? 1.0 : -1.0;
    DegreeFactors result;
    result.left = Eigen::MatrixXd::Zero(rays * nc, 2 * degrees);
    result.right = result.left;
    for (int l = m; l <= order; ++l) {
        const bool linear = ((l + m) % 2 == 0) == even;
        const int c0 = linear ? 0 : 2, column = 2 * (l - m);
        Eigen::Matrix2d s;
        if (linear)
            s << x.alpha1[l], x.beta1[l], x.beta1[l], x.alpha2[l];
        else
            s << x.alpha3[l], sign * x.beta2[l], sign * x.beta2[l], -x.alpha4[l];
        if (l == m) result.first = s;
        for (int i = 0; i < rays; ++i)
            for (int c = 0; c < nc; ++c)
                for (int k = 0; k < 2; ++k)
                    result.left(i * nc + c, column + k) = element(d, components.first + c, c0 + k, i, l);
        result.right.middleCols(column, 2) = result.left.middleCols(column, 2) * s;
    }
    return result;
}

void scale_rays(const Eigen::VectorXd& scale, int components, DegreeFactors& factors) {
    for (Eigen::Index i = 0; i < scale.size(); ++i) {
        factors.left.middleRows(i * components, components) *= scale[i];
        factors.right.middleRows(i * components, components) *= scale[i];
    }
}

}  // namespace

PhaseSums phase_sums(const optics::ExpansionCoefficients& expansion, const Medium& medium, int m) {
    const WignerTables d(expansion.order(), m, medium.mu);
    const Eigen::VectorXd scale = medium.scale.cwiseQuotient(medium.mu);
    Eigen::MatrixXd x, y;
    for (const bool even : {true, false}) {
        DegreeFactors factors = degree_factors(d, expansion, m, {0, 4}, even);
        scale_rays(scale, 4, factors);
        (even ? x : y).noalias() = 0.5 * factors.left * factors.right.transpose();
    }
    // Take the P out again.
    for (Eigen::Index v = 3; v < x.rows(); v += 4) {
        x.row(v) *= -1.0;
        y.col(v) *= -1.0;
    }
    return {x + y, x - y};
}

void LayerKernel::finish(int nc, bool carries_flux, TransferSystem<double>& result) const {
    // Cut what view rays would emit and beam rays receive, then add the extinction.
    for (int i = 0; i < medium_.size(); ++i) {
        if (medium_.roles[i] == Role::quadrature) result.quadrature += nc;
        if (medium_.roles[i] == Role::view) result.views += nc;
        for (Eigen::MatrixXd* matrix : {&result.h, &result.g}) {
            if (medium_.roles[i] == Role::view) matrix->middleCols(i * nc, nc).setZero();
            if (medium_.roles[i] == Role::beam) matrix->middleRows(i * nc, nc).setZero();
            for (int c = i * nc; c < (i + 1) * nc; ++c) (*matrix)(c, c) += result.signature[c] / medium_.mu[i];
        }
    }

    if (layer_.single_scattering_albedo == 1.0 && carries_flux) {
        result.isotropic = result.flux = Eigen::VectorXd::Zero(result.size());
        for (int i = 0; i < medium_.size(); ++i) {
            if (medium_.roles[i] != Role::beam) result.isotropic[i * nc] = medium_.scale[i];
            if (medium_.roles[i] != Role::view) result.flux[i * nc] = medium_.scale[i];
        }
    }
}

TransferSystem<double> LayerKernel::system(int m, Components components) const {
    const auto& x = layer_.expansion;
    const int order = x.order(), rays = medium_.size(), nc = components.count;
    const int n = rays * nc;
    TransferSystem<double> result;
    result.signature = Eigen::VectorXd::Ones(n);
    result.smallest_mu = medium_.mu.minCoeff();
    for (int i = 0; i < rays; ++i)
        if (components.first + nc == 4) result.signature[i * nc + nc - 1] = -1.0;

    const WignerTables d(order, m, medium_.mu);
    Eigen::VectorXd ray_scale = medium_.scale.cwiseQuotient(medium_.mu);
    const bool repairs = m == 0 && components.first == 0;
    for (const bool even : {true, false}) {
        DegreeFactors factors = degree_factors(d, x, m, components, even);
        // Degree 0 makes the kernel conservative.
        if (repairs && even && order >= 0) {
            for (int i = 0; i < rays; ++i) {
                factors.left(i * nc, 0) = isotropic_i_[i];
                if (nc > 1) factors.left(i * nc + 1, 0) = isotropic_q_[i];
            }
            factors.right.leftCols(2) = factors.left.leftCols(2) * factors.first;
        }
        scale_rays(ray_scale, nc, factors);
        Eigen::MatrixXd& target = even ? result.h : result.g;
        target.noalias() = -layer_.single_scattering_albedo * factors.left * factors.right.transpose();
    }

    finish(nc, m == 0 && components.first == 0, result);
    return result;
}

}  // namespace patina::rt
