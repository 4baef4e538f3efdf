#include "patina/rt/solvers/signed_cholesky.h"

#include <cmath>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include "patina/core/contract.h"

namespace patina::rt {

namespace {

using Vector8 [[gnu::vector_size(64), gnu::aligned(8), gnu::may_alias]] = double;

inline Vector8 fused(Vector8 a, Vector8 b, Vector8 c) {
#ifdef __AVX512F__
    return static_cast<Vector8>(_mm512_fmadd_pd(a, b, c));
#else
    return a * b + c;
#endif
}

// c += a b^T over `depth` columns, for a tile of 8 Rows rows and 8 columns; all column-major.
template <int Rows>
inline void tile(int depth, const double* a, int lda, const double* b, int ldb, double* c, int ldc) {
    Vector8 sum[Rows][8];
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < Rows; ++i) sum[i][j] = *reinterpret_cast<const Vector8*>(c + j * ldc + 8 * i);
    for (int p = 0; p < depth; ++p, a += lda, b += ldb) {
        Vector8 column[Rows];
        for (int i = 0; i < Rows; ++i) column[i] = *reinterpret_cast<const Vector8*>(a + 8 * i);
#pragma GCC unroll 8
        for (int j = 0; j < 8; ++j) {
            const Vector8 factor = b[j] - Vector8{};
#pragma GCC unroll 3
            for (int i = 0; i < Rows; ++i) sum[i][j] = fused(column[i], factor, sum[i][j]);
        }
    }
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < Rows; ++i) *reinterpret_cast<Vector8*>(c + j * ldc + 8 * i) = sum[i][j];
}

// The same for any multiple of 8 rows.
void rank_update(int rows, int depth, const double* a, int lda, const double* b, int ldb, double* c, int ldc) {
    int i = 0;
    for (; i + 24 <= rows; i += 24) tile<3>(depth, a + i, lda, b, ldb, c + i, ldc);
    if (rows - i == 16) tile<2>(depth, a + i, lda, b, ldb, c + i, ldc);
    if (rows - i == 8) tile<1>(depth, a + i, lda, b, ldb, c + i, ldc);
}

using Block = Eigen::Matrix<double, 8, 8>;

// Factorizes the 8 x 8 block at `s` into L D L^T; the inverse of L goes to `inverse`.
bool factorize_block(const double* s, int lds, const double* signs, Block& inverse) {
    Block l = Block::Zero();
    inverse.setZero();
    for (int j = 0; j < 8; ++j) {
        double pivot = s[j + j * lds];
        for (int p = 0; p < j; ++p) pivot -= l(j, p) * l(j, p) * signs[p];
        pivot *= signs[j];
        if (!(pivot > 0.0)) return false;
        const double reciprocal = 1.0 / std::sqrt(pivot);
        l(j, j) = pivot * reciprocal;
        for (int i = j + 1; i < 8; ++i) {
            double value = s[i + j * lds];
            for (int p = 0; p < j; ++p) value -= l(i, p) * l(j, p) * signs[p];
            l(i, j) = value * signs[j] * reciprocal;
        }
        // Row j of the inverse: L^-1 is lower triangular too.
        for (int q = 0; q < j; ++q) {
            double value = 0.0;
            for (int p = q; p < j; ++p) value -= l(j, p) * inverse(p, q);
            inverse(j, q) = value * reciprocal;
        }
        inverse(j, j) = reciprocal;
    }
    return true;
}

}  // namespace

bool SignedCholesky::compute(const Eigen::MatrixXd& s, const Eigen::VectorXd& signature) {
    const int n = static_cast<int>(s.rows());
    PATINA_EXPECT(n % block == 0 && s.cols() == n && signature.size() == n);
    d_ = signature;
    l_.setZero(n, n);
    scaled_.resize(n, n);
    inverses_.resize(n / block);
    Eigen::Matrix<double, Eigen::Dynamic, block> panel(n, block);
    for (int k = 0; k < n; k += block) {
        // Bring the panel up to date with the columns before it.
        const int rows = n - k;
        panel.topRows(rows) = -s.block(k, k, rows, block);
        rank_update(rows, k, l_.data() + k, n, scaled_.data() + k, n, panel.data(), n);
        panel.topRows(rows) *= -1.0;

        // Factorize its top block and divide the rest by it: L21 = S21 L11^-T D.
        Block& inverse = inverses_[k / block];
        if (!factorize_block(panel.data(), n, d_.data() + k, inverse)) return false;
        const Block divisor = d_.segment<block>(k).asDiagonal() * inverse;
        rank_update(rows, block, panel.data(), n, divisor.data(), block,
                    l_.data() + k + static_cast<std::ptrdiff_t>(k) * n, n);
        scaled_.block(k, k, rows, block) = l_.block(k, k, rows, block) * d_.segment<block>(k).asDiagonal();
    }
    return true;
}

void SignedCholesky::solve_right(Eigen::MatrixXd& v, bool upper) const {
    const int n = static_cast<int>(v.rows());
    Eigen::Matrix<double, Eigen::Dynamic, block> panel(n, block);
    for (int k = 0; k < n; k += block) {
        const int rows = upper ? k + block : n;
        panel.topRows(rows) = -v.block(0, k, rows, block);
        rank_update(rows, k, v.data(), n, l_.data() + k, n, panel.data(), n);
        v.block(0, k, rows, block).setZero();
        const Block divisor = -inverses_[k / block];
        rank_update(rows, block, panel.data(), n, divisor.data(), block, v.data() + static_cast<std::ptrdiff_t>(k) * n,
                    n);
    }
}

Eigen::MatrixXd SignedCholesky::inverse() const {
    const int n = static_cast<int>(l_.rows());
    Eigen::MatrixXd v = Eigen::MatrixXd::Identity(n, n);
    solve_right(v, true);
    const Eigen::MatrixXd w = v * d_.asDiagonal();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
    for (int k = 0; k < n; k += block)
        for (int i = k; i < n; i += 3 * block) {
            const std::ptrdiff_t column = static_cast<std::ptrdiff_t>(i) * n;
            rank_update(std::min(3 * block, n - i), n - i, v.data() + i + column, n, w.data() + k + column, n,
                        result.data() + i + static_cast<std::ptrdiff_t>(k) * n, n);
        }
    result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
    return result;
}

void SignedCholesky::parallel_difference(const Eigen::MatrixXd& a, double factor, Eigen::MatrixXd& result) const {
    const int n = static_cast<int>(l_.rows());
    Eigen::MatrixXd v = a;
    solve_right(v, false);
    const Eigen::MatrixXd w = v * (-factor * d_).asDiagonal();
    result = factor * a;
    for (int k = 0; k < n; k += block)
        rank_update(n - k, n, v.data() + k, n, w.data() + k, n, result.data() + k + static_cast<std::ptrdiff_t>(k) * n,
                    n);
    result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
}

}  // namespace patina::rt
