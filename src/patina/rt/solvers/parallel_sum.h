#pragma once
// Inverses and parallel sums of the matrices of the doubling core.

#include <Eigen/Dense>

#include "patina/rt/solvers/signed_cholesky.h"

namespace patina::rt {

// For symmetric matrices of the signature of P the pivots of a factorization without exchanges have the signs of P
// (quasi-definite matrices: Vanderbei 1995, SIAM J. Optim. 5, 100), which takes a third of the work. Others go through
// LU. Symmetric double matrices must have a size that is a multiple of SignedCholesky::block.
template <class Scalar>
class Arithmetic {
  public:
    using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

    Arithmetic(const Vector& signature, bool symmetric) : signature_(signature), symmetric_(symmetric) {}

    // a <- 1/a.
    void invert(Matrix& a);
    // a <- factor (a - a sum^-1 a): for factor 1 the parallel sum 1/(1/a + 1/b) of a and b = sum - a; either may be
    // singular.
    void parallel_difference(Matrix& a, const Matrix& sum, Scalar factor);

  private:
    const Vector& signature_;
    bool symmetric_;
    SignedCholesky cholesky_;
};

}  // namespace patina::rt
