#pragma once
// The discretised transfer equation of one layer and one Fourier order.
//
// Unknowns are y = sqrt(mu w) I on the quadrature rays, ray by ray, the Stokes components of a ray together. With I+
// the downward and Delta I- the upward radiance, Delta = diag(1,1,-1,-1), the sum S = I+ + Delta I- and difference D =
// I+ - Delta I- obey S' = -G D, D' = -H S (derivatives in optical depth). Reciprocity makes P H and G P symmetric, P =
// diag(1,1,1,-1), and these are what is kept. View rays have rows only and beam rays columns only (besides their
// diagonal): such block triangular matrices are closed under products and inverses, which is the algebra of
// "diagonal plus kernel" with sums over the quadrature rays alone.

#include <vector>

#include <Eigen/Dense>

#include "patina/rt/nodes.h"
#include "patina/rt/problem.h"

namespace patina::rt {

// The Stokes components solved together: IQUV, or at m = 0 the uncoupled pairs IQ and UV, or I alone (scalar).
struct Components {
    int first = 0;
    int count = 4;
};

template <class Scalar>
struct TransferSystem {
    using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

    Matrix h;                       // P H
    Matrix g;                       // G P
    Vector signature;               // the diagonal of P
    int quadrature = 0, views = 0;  // unknowns of the quadrature rays, then of the view rays; the rest are beams
    // In a conservative layer H isotropic = 0 and flux^T H = 0; empty otherwise.
    Vector isotropic, flux;
    double smallest_mu = 1.0;

    int size() const { return static_cast<int>(signature.size()); }
    bool symmetric() const { return quadrature == size(); }
};

// Builds the systems of one layer for every Fourier order.
class LayerKernel {
  public:
    LayerKernel(const Layer& layer, const Medium& medium);

    TransferSystem<double> system(int m, Components components) const;
    // How far the quadrature is from integrating the phase function to 1, for the worst ray.
    double quadrature_error() const { return (isotropic_i_.array() - 1.0).abs().maxCoeff(); }

  private:
    // Extinction, the zeros of view and beam rays, and the conserved flux.
    void finish(int components, bool carries_flux, TransferSystem<double>& result) const;

    const Layer& layer_;
    const Medium& medium_;
    // The degree-0 factors of I and Q at m = 0: they differ from 1 and 0 by the quadrature error of the higher degrees,
    // so that the kernel conserves energy exactly on these nodes.
    Eigen::VectorXd isotropic_i_, isotropic_q_;
};

// Light scattered from ray j into ray i per optical depth, all four components, in the same variables and for albedo 1:
// downward into downward or (upward times Delta) into (upward times Delta), and between the two.
struct PhaseSums {
    Eigen::MatrixXd same, opposite;
};
PhaseSums phase_sums(const optics::ExpansionCoefficients& expansion, const Medium& medium, int m);

// d^l_mn at all cosines: one column a degree l = 0 .. order (columns below max(|m|,|n|) are 0).
Eigen::MatrixXd wigner_d_table(int order, int m, int n, const Eigen::VectorXd& mu);

}  // namespace patina::rt
