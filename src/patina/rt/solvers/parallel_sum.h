#pragma once
// Inverses and parallel sums of the matrices of the doubling core.

#include <Eigen/Dense>

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

    Matrix inverse(const Matrix& a) const;
    // factor (a - a sum^-1 a), for factor 1 the parallel sum of a and sum - a.
    Matrix parallel_difference(const Matrix& a, const Matrix& sum, Scalar factor) const;
    // 1/(1/a + 1/b); either may be singular.
    Matrix parallel_sum(const Matrix& a, const Matrix& b) const { return parallel_difference(a, a + b, 1); }

  private:
    const Vector& signature_;
    bool symmetric_;
};

}  // namespace patina::rt
