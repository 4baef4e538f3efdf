#include "patina/rt/solvers/signed_cholesky.h"

#include <cmath>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include "patina/core/contract.h"

namespace patina::rt {

namespace {

using Vector8 [[gnu::vector_size(64), gnu::aligned(8), gnu::may_alias]] = double;

enum class Update { subtract, replace };

// c - a b or c + a b.
template <Update update>
inline Vector8 accumulate(Vector8 a, Vector8 b, Vector8 c) {
#ifdef __AVX512F__
    return static_cast<Vector8>(update == Update::subtract ? _mm512_fnmadd_pd(a, b, c) : _mm512_fmadd_pd(a, b, c));
#else
    return update == Update::subtract ? c - a * b : c + a * b;
#endif
}

// c - a b^T or a b^T over `depth` columns, for a tile of 8 Rows rows and 8 columns; all column-major. A replaced tile
// may be the very tile of a, because it is written after everything is read.
template <int Rows, Update update>
inline void tile(int depth, const double* a, int lda, const double* b, int ldb, double* c, int ldc) {
    Vector8 sum[Rows][8];
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < Rows; ++i) {
            if constexpr (update == Update::subtract)
                sum[i][j] = *reinterpret_cast<const Vector8*>(c + j * ldc + 8 * i);
            else
                sum[i][j] = Vector8{};
        }
    for (int p = 0; p < depth; ++p, a += lda, b += ldb) {
        Vector8 column[Rows];
        for (int i = 0; i < Rows; ++i) column[i] = *reinterpret_cast<const Vector8*>(a + 8 * i);
#pragma GCC unroll 8
        for (int j = 0; j < 8; ++j) {
            const Vector8 factor = Vector8{} + b[j];
#pragma GCC unroll 3
            for (int i = 0; i < Rows; ++i) sum[i][j] = accumulate<update>(column[i], factor, sum[i][j]);
        }
    }
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < Rows; ++i) *reinterpret_cast<Vector8*>(c + j * ldc + 8 * i) = sum[i][j];
}

// The same for any multiple of 8 rows.
template <Update update>
void rank_update(int rows, int depth, const double* a, int lda, const double* b, int ldb, double* c, int ldc) {
    int i = 0;
    for (; i + 24 <= rows; i += 24) tile<3, update>(depth, a + i, lda, b, ldb, c + i, ldc);
    if (rows - i == 16) tile<2, update>(depth, a + i, lda, b, ldb, c + i, ldc);
    if (rows - i == 8) tile<1, update>(depth, a + i, lda, b, ldb, c + i, ldc);
}

double* at(Eigen::MatrixXd& matrix, int row, int column) {
    return matrix.data() + row + static_cast<std::ptrdiff_t>(column) * matrix.rows();
}

// Copies the lower triangle to the upper one, in blocks of 8.
void mirror(Eigen::MatrixXd& matrix) {
    const int n = static_cast<int>(matrix.rows());
    for (int k = 0; k < n; k += 8) {
        for (int j = 1; j < 8; ++j)
            for (int i = 0; i < j; ++i) matrix(k + i, k + j) = matrix(k + j, k + i);
        for (int i = k + 8; i < n; i += 8) matrix.block<8, 8>(k, i) = matrix.block<8, 8>(i, k).transpose();
    }
}

using Block = Eigen::Matrix<double, 8, 8>;

// Factorizes the symmetric 8 x 8 block `s` into L D L^T, in place; the inverse of L goes to `inverse`.
bool factorize_block(Block& s, const double* signs, Block& inverse) {
    Block l = Block::Zero();
    inverse.setZero();
    for (int j = 0; j < 8; ++j) {
        double pivot = s(j, j);
        for (int p = 0; p < j; ++p) pivot -= l(j, p) * l(j, p) * signs[p];
        pivot *= signs[j];
        if (!(pivot > 0.0)) return false;
        const double reciprocal = 1.0 / std::sqrt(pivot);
        l(j, j) = pivot * reciprocal;
        for (int i = j + 1; i < 8; ++i) {
            double value = s(i, j);
            for (int p = 0; p < j; ++p) value -= l(i, p) * l(j, p) * signs[p];
            l(i, j) = value * signs[j] * reciprocal;
        }
        // Row j of the inverse, which is lower triangular too.
        for (int q = 0; q < j; ++q) {
            double value = 0.0;
            for (int p = q; p < j; ++p) value -= l(j, p) * inverse(p, q);
            inverse(j, q) = value * reciprocal;
        }
        inverse(j, j) = reciprocal;
    }
    s = l;
    return true;
}

}  // namespace

bool SignedCholesky::compute(const Eigen::MatrixXd& s, const Eigen::VectorXd& signature) {
    const int n = static_cast<int>(s.rows());
    PATINA_EXPECT(n % block == 0 && s.cols() == n && signature.size() == n);
    d_ = signature;
    l_.resize(n, n);
    l_signed_.resize(n, n);
    inverses_.resize(n / block);
    for (int k = 0; k < n; k += block) {
        // Bring the block column up to date with those before it.
        const int rows = n - k, rest = rows - block;
        l_.block<Eigen::Dynamic, block>(k, k, rows, block) = s.block<Eigen::Dynamic, block>(k, k, rows, block);
        rank_update<Update::subtract>(rows, k, at(l_, k, 0), n, at(l_signed_, k, 0), n, at(l_, k, k), n);

        // Factorize its top block and divide the rest by it: L21 = S21 L11^-T D.
        Block& inverse = inverses_[k / block];
        Block top = l_.block<block, block>(k, k);
        if (!factorize_block(top, d_.data() + k, inverse)) return false;
        l_.block<block, block>(k, k) = top;
        const Block divisor = d_.segment<block>(k).asDiagonal() * inverse;
        rank_update<Update::replace>(rest, block, at(l_, k + block, k), n, divisor.data(), block, at(l_, k + block, k),
                                     n);
        for (int j = k; j < k + block; ++j) l_signed_.col(j).tail(rows) = d_[j] * l_.col(j).tail(rows);
    }
    return true;
}

void SignedCholesky::solve_right(bool upper) {
    const int n = static_cast<int>(solved_.rows());
    for (int k = 0; k < n; k += block) {
        const int rows = upper ? k + block : n;
        rank_update<Update::subtract>(rows, k, solved_.data(), n, at(l_, k, 0), n, at(solved_, 0, k), n);
        rank_update<Update::replace>(rows, block, at(solved_, 0, k), n, inverses_[k / block].data(), block,
                                     at(solved_, 0, k), n);
    }
}

void SignedCholesky::inverse(Eigen::MatrixXd& result) {
    const int n = static_cast<int>(l_.rows());
    solved_.setIdentity(n, n);
    solve_right(true);
    solved_signed_.resize(n, n);
    for (int j = 0; j < n; ++j) solved_signed_.col(j) = d_[j] * solved_.col(j);
    result.resize(n, n);
    for (int k = 0; k < n; k += block)
        for (int i = k; i < n; i += 3 * block)
            rank_update<Update::replace>(std::min(3 * block, n - i), n - i, at(solved_, i, i), n,
                                         at(solved_signed_, k, i), n, at(result, i, k), n);
    mirror(result);
}

void SignedCholesky::parallel_difference(Eigen::MatrixXd& a, double factor) {
    const int n = static_cast<int>(l_.rows());
    solved_ = a;
    solve_right(false);
    solved_signed_.resize(n, n);
    for (int j = 0; j < n; ++j) solved_signed_.col(j) = factor * d_[j] * solved_.col(j);
    if (factor != 1.0) a *= factor;
    for (int k = 0; k < n; k += block)
        rank_update<Update::subtract>(n - k, n, at(solved_, k, 0), n, at(solved_signed_, k, 0), n, at(a, k, k), n);
    mirror(a);
}

}  // namespace patina::rt
