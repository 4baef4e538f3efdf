#pragma once
// Signed Cholesky factorization S = L D L^T, D = diag(+-1), and what the doubling core needs of it, in double.
//
// Matrices are column-major n x n with n a multiple of 8, so that every inner loop is the product of a tile of up to 24
// rows with the transpose of 8 rows: no packing, everything stays in the first cache levels for n <= 256.

#include <vector>

#include <Eigen/Dense>

namespace patina::rt {

class SignedCholesky {
  public:
    static constexpr int block = 8;

    // Factorizes from the lower triangle of s. False when a pivot has not the sign that `signature` expects: the matrix
    // is not quasi-definite and wants row exchanges.
    bool compute(const Eigen::MatrixXd& s, const Eigen::VectorXd& signature);

    // The inverse of S.
    Eigen::MatrixXd inverse() const;
    // 2^exponent (a - a S^-1 a) for symmetric a; `factor` is 1 or 2.
    void parallel_difference(const Eigen::MatrixXd& a, double factor, Eigen::MatrixXd& result) const;

  private:
    // v L^-T in place; `upper`: v is upper triangular.
    void solve_right(Eigen::MatrixXd& v, bool upper) const;

    Eigen::MatrixXd l_, scaled_;                                 // L and L D; lower triangles
    std::vector<Eigen::Matrix<double, block, block>> inverses_;  // of the diagonal blocks of L
    Eigen::VectorXd d_;
};

}  // namespace patina::rt
