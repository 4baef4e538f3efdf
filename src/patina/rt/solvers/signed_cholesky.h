#pragma once
// Signed Cholesky factorization S = L D L^T, D = diag(+-1), and what the doubling core needs of it, in double.
//
// Matrices are column-major n x n with n a multiple of 8, so that every inner loop is the product of a tile of up to
// three registers of rows (24 doubles with AVX-512, 12 with AVX2) with the transpose of 8 or 4 rows: no packing,
// everything stays in the first cache levels for n <= 256.

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
    void inverse(Eigen::MatrixXd& result);
    // a <- factor (a - a S^-1 a) for symmetric a.
    void parallel_difference(Eigen::MatrixXd& a, double factor);

  private:
    // solved_ <- solved_ L^-T; `upper`: it is upper triangular.
    void solve_right(bool upper);

    // Kept between calls, so that a layer is solved without allocations.
    Eigen::MatrixXd l_, l_signed_;  // L and L D, lower triangles
    Eigen::MatrixXd solved_, solved_signed_;
    std::vector<Eigen::Matrix<double, block, block>> inverses_;  // of the diagonal blocks of L
    Eigen::VectorXd d_;
};

}  // namespace patina::rt
