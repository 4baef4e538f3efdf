#include "patina/rt/solvers/eigenmode_layer.h"

#include <cmath>
#include <complex>

#include <Eigen/Eigenvalues>

#include "patina/core/error.h"

namespace patina::rt {

namespace {

using Complex = std::complex<double>;
using ComplexMatrix = Eigen::MatrixXcd;
using ComplexVector = Eigen::VectorXcd;

// H and G without the signature, cut into blocks of quadrature (r), view (v) and beam (b) unknowns. `shift` displaces
// the extinction of view and beam rays relatively.
struct Blocks {
    Eigen::MatrixXd h, g;
    Eigen::VectorXd isotropic;  // of a conservative layer, else empty
    int r, v, b;

    Blocks(const TransferSystem<double>& system, double view_shift, double beam_shift)
        : h(system.signature.asDiagonal() * system.h),
          g(system.g * system.signature.asDiagonal()),
          isotropic(system.isotropic),
          r(system.quadrature),
          v(system.views),
          b(system.size() - r - v) {
        for (Eigen::MatrixXd* matrix : {&h, &g}) {
            matrix->diagonal().segment(r, v) *= 1.0 + view_shift;
            matrix->diagonal().tail(b) *= 1.0 + beam_shift;
        }
    }
};

// The eigenmodes of the quadrature rays, and R + T, R - T among them.
struct Modes {
    ComplexMatrix vectors, gradients;                   // V and W = G^-1 V
    ComplexVector squares;                              // k^2
    ComplexVector p[2], q[2];                           // Weights for R + T and R - T
    ComplexMatrix r[2];                                 // R + T, R - T
    Eigen::PartialPivLU<ComplexMatrix> denominator[2];  // of the transposed sums of what enters
    Eigen::PartialPivLU<ComplexMatrix> basis;
};

ComplexMatrix numerator(const ComplexMatrix& v, const ComplexMatrix& w, const ComplexVector& p,
                        const ComplexVector& q) {
    return 0.5 * (v * p.asDiagonal() - w * q.asDiagonal());
}
ComplexMatrix denominator(const ComplexMatrix& v, const ComplexMatrix& w, const ComplexVector& p,
                          const ComplexVector& q) {
    return 0.5 * (v * p.asDiagonal() + w * q.asDiagonal());
}

// x d^-1, d given by the factors of its transpose.
ComplexMatrix right_solve(const Eigen::PartialPivLU<ComplexMatrix>& d_transposed, const ComplexMatrix& x) {
    return d_transposed.solve(x.transpose()).transpose();
}

constexpr double signs[2] = {1.0, -1.0};

// (1 - e^{-k tau})/k, for k = 0 too.
Complex decayed(Complex k, double tau) {
    const Complex x = k * tau;
    if (std::abs(x) > 1e-2) return (1.0 - std::exp(-x)) / k;
    return tau * (1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0 * (1.0 - x / 6.0)))));
}

// The weights of V and W where light enters both faces equally, p = 1 + E and q = k (1 - E), and with opposite signs, p
// = (1 - E)/k and q = 1 + E. A deep layer has p = 1 and q = k for both.
void weigh(double tau, Modes& modes) {
    const auto n = modes.squares.size();
    for (int s = 0; s < 2; ++s) modes.p[s] = modes.q[s] = ComplexVector::Ones(n);
    for (Eigen::Index j = 0; j < n; ++j) {
        const Complex k = std::sqrt(modes.squares[j]);
        if (std::isinf(tau)) {
            modes.q[0][j] = modes.q[1][j] = k;
            continue;
        }
        const Complex sum = decayed(k, tau);
        modes.p[0][j] = modes.q[1][j] = 1.0 + std::exp(-tau * k);
        modes.q[0][j] = modes.squares[j] * sum;
        modes.p[1][j] = sum;
    }
}

Modes quadrature_modes(const Blocks& s, double tau) {
    const Eigen::MatrixXd h = s.h.topLeftCorner(s.r, s.r), g = s.g.topLeftCorner(s.r, s.r);
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(g * h);
    if (solver.info() != Eigen::Success)
        throw Error(ErrorKind::check, "the eigenmodes of the transfer equation did not converge; use solver doubling");
    Modes modes;
    modes.vectors = solver.eigenvectors();
    modes.squares = solver.eigenvalues();
    if (s.isotropic.size() > 0) {  // whose decay is 0 but for rounding
        Eigen::Index slowest = 0;
        modes.squares.cwiseAbs().minCoeff(&slowest);
        modes.squares[slowest] = 0;
        modes.vectors.col(slowest) = s.isotropic.head(s.r).cast<Complex>();
    }
    modes.gradients = g.cast<Complex>().partialPivLu().solve(modes.vectors);
    modes.basis.compute(modes.vectors);
    weigh(tau, modes);
    for (int k = 0; k < 2; ++k) {
        modes.denominator[k].compute(denominator(modes.vectors, modes.gradients, modes.p[k], modes.q[k]).transpose());
        modes.r[k] =
            right_solve(modes.denominator[k], numerator(modes.vectors, modes.gradients, modes.p[k], modes.q[k]));
    }
    return modes;
}

// R + T and R - T over all rays: the eigenvectors of the block triangular G H follow from those of the quadrature
// block.
void extend(const Blocks& s, const Modes& modes, double tau, double weight, Eigen::MatrixXd sums[2]) {
    const int r = s.r, v = s.v, b = s.b;
    const Eigen::MatrixXd gh = s.g * s.h;
    const ComplexMatrix h = s.h.cast<Complex>();
    const Eigen::ArrayXd view_rate = s.h.diagonal().segment(r, v), beam_rate = s.h.diagonal().tail(b);

    // View components of the quadrature modes.
    ComplexMatrix xv = gh.block(r, 0, v, r).cast<Complex>() * modes.vectors;
    for (int j = 0; j < r; ++j) xv.col(j).array() /= modes.squares[j] - view_rate.square().cast<Complex>();
    const ComplexMatrix wv = s.g.diagonal().segment(r, v).cwiseInverse().cast<Complex>().asDiagonal() *
                             (xv - s.g.block(r, 0, v, r).cast<Complex>() * modes.gradients);

    // The modes that decay as the beam.
    ComplexMatrix coefficients = modes.basis.solve(gh.block(0, r + v, r, b).cast<Complex>());
    for (int j = 0; j < b; ++j) coefficients.col(j).array() /= beam_rate[j] * beam_rate[j] - modes.squares.array();
    const ComplexMatrix xr = modes.vectors * coefficients;
    ComplexMatrix xb = gh.block(r, 0, v, r).cast<Complex>() * xr + gh.block(r, r + v, v, b).cast<Complex>();
    for (int j = 0; j < b; ++j) xb.col(j).array() /= (beam_rate[j] * beam_rate[j] - view_rate.square()).cast<Complex>();
    const auto per_beam = beam_rate.inverse().matrix().cast<Complex>().asDiagonal();
    const ComplexMatrix wr = (h.topLeftCorner(r, r) * xr + h.block(0, r + v, r, b)) * per_beam;
    const ComplexMatrix wb =
        (h.block(r, 0, v, r) * xr + view_rate.matrix().cast<Complex>().asDiagonal() * xb + h.block(r, r + v, v, b)) *
        per_beam;

    // Solve R D = N block by block.
    const ComplexVector view_decay = (-tau * view_rate).exp().cast<Complex>(),
                        beam_decay = (-tau * beam_rate).exp().cast<Complex>();
    const ComplexVector one = ComplexVector::Ones(b);
    for (int k = 0; k < 2; ++k) {
        const double sign = signs[k];
        const ComplexVector rv = sign * view_decay;
        const ComplexMatrix r_vr =
            right_solve(modes.denominator[k], numerator(xv, wv, modes.p[k], modes.q[k]) -
                                                  rv.asDiagonal() * denominator(xv, wv, modes.p[k], modes.q[k]));
        const ComplexVector p = one + sign * beam_decay, q = one - sign * beam_decay;
        const ComplexMatrix d_rb = denominator(xr, wr, p, q), d_vb = denominator(xb, wb, p, q);
        const ComplexMatrix r_rb = numerator(xr, wr, p, q) - modes.r[k] * d_rb;
        const ComplexMatrix r_vb = numerator(xb, wb, p, q) - rv.asDiagonal() * d_vb - r_vr * d_rb;
        sums[k].block(r, 0, v, r) += weight * r_vr.real();
        sums[k].block(0, r + v, r, b) += weight * r_rb.real();
        sums[k].block(r, r + v, v, b) += weight * r_vb.real();
    }
}

}  // namespace

LayerOperators<double> EigenmodeMethod::solve(const TransferSystem<double>& system, const LayerRequest& request) const {
    const double tau = request.optical_thickness;
    const int n = system.size();
    const Blocks blocks(system, 0.0, 0.0);
    stop_if_requested(request.cancel);
    const Modes modes = quadrature_modes(blocks, tau);
    Eigen::MatrixXd sums[2];
    for (int k = 0; k < 2; ++k) {
        sums[k] = Eigen::MatrixXd::Zero(n, n);
        sums[k].topLeftCorner(blocks.r, blocks.r) = modes.r[k].real();
        sums[k].diagonal().tail(n - blocks.r) =
            signs[k] * (-tau * blocks.h.diagonal().tail(n - blocks.r).array()).exp();
    }

    // A view ray may decay as the beam or as a mode, where eigenvectors coincide though the radiance is smooth:
    // displace the rates a little to both sides and extrapolate (error of the fourth order, 1e-12).
    if (!system.symmetric()) {
        constexpr double step = 1e-3;
        for (const auto& [shift, weight] :
             {std::pair{step, 2.0 / 3}, {-step, 2.0 / 3}, {2 * step, -1.0 / 6}, {-2 * step, -1.0 / 6}}) {
            stop_if_requested(request.cancel);
            extend(Blocks(system, shift, -0.5 * shift), modes, tau, weight, sums);
        }
    }

    LayerOperators<double> result;
    result.reflection = 0.5 * (sums[0] + sums[1]);
    if (request.transmission && std::isfinite(tau)) result.transmission = 0.5 * (sums[0] - sums[1]);
    return result;
}

}  // namespace patina::rt
