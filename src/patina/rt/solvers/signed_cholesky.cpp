#include "patina/rt/solvers/signed_cholesky.h"

#include <cmath>
#include <type_traits>

#if defined(__AVX512F__) || defined(__FMA__)
#include <immintrin.h>
#endif

#include "patina/core/contract.h"

namespace patina::rt {

namespace {

// A register full of doubles, and how many columns of a tile three of them high leave room for the rest.
#ifdef __AVX512F__
constexpr int lanes = 8, most_columns = 8;
#else
constexpr int lanes = 4, most_columns = 4;
#endif
using Vector [[gnu::vector_size(8 * lanes), gnu::aligned(8), gnu::may_alias]] = double;

enum class Update { subtract, replace };

// c - a b or c + a b.
template <Update update>
inline Vector accumulate(Vector a, Vector b, Vector c) {
#if defined(__AVX512F__)
    return static_cast<Vector>(update == Update::subtract ? _mm512_fnmadd_pd(a, b, c) : _mm512_fmadd_pd(a, b, c));
#elif defined(__FMA__)
    return static_cast<Vector>(update == Update::subtract ? _mm256_fnmadd_pd(a, b, c) : _mm256_fmadd_pd(a, b, c));
#else
    return update == Update::subtract ? c - a * b : c + a * b;
#endif
}

// c - a b^T or a b^T over `depth` columns, for a tile of Height registers of rows and as many columns; all
// column-major. Everything is read before anything is written.
template <int Height, int Columns, Update update>
inline void tile(int depth, const double* a, int lda, const double* b, int ldb, double* c, int ldc) {
    Vector sum[Height][Columns];
    for (int j = 0; j < Columns; ++j)
        for (int i = 0; i < Height; ++i) {
            if constexpr (update == Update::subtract)
                sum[i][j] = *reinterpret_cast<const Vector*>(c + j * ldc + lanes * i);
            else
                sum[i][j] = Vector{};
        }
    for (int p = 0; p < depth; ++p, a += lda, b += ldb) {
        Vector column[Height];
        for (int i = 0; i < Height; ++i) column[i] = *reinterpret_cast<const Vector*>(a + lanes * i);
#pragma GCC unroll 8
        for (int j = 0; j < Columns; ++j) {
            const Vector factor = Vector{} + b[j];
#pragma GCC unroll 3
            for (int i = 0; i < Height; ++i) sum[i][j] = accumulate<update>(column[i], factor, sum[i][j]);
        }
    }
    for (int j = 0; j < Columns; ++j)
        for (int i = 0; i < Height; ++i) *reinterpret_cast<Vector*>(c + j * ldc + lanes * i) = sum[i][j];
}

// Eight columns of such a tile.
template <int Height, Update update>
inline void eight_columns(int depth, const double* a, int lda, const double* b, int ldb, double* c, int ldc) {
    for (int j = 0; j < 8; j += most_columns)
        tile<Height, most_columns, update>(depth, a, lda, b + j, ldb, c + j * ldc, ldc);
}

// The same for any multiple of 8 rows, in tiles of three registers and, for what is left, of two or one.
template <Update update>
void rank_update(int rows, int depth, const double* a, int lda, const double* b, int ldb, double* c, int ldc) {
    int i = 0;
    const auto go_on = [&](auto height, int until) {
        for (; i + lanes * height <= until; i += lanes * height)
            eight_columns<height, update>(depth, a + i, lda, b, ldb, c + i, ldc);
    };
    go_on(std::integral_constant<int, 3>{}, rows - rows % 24);
    go_on(std::integral_constant<int, 2>{}, rows);
    go_on(std::integral_constant<int, 1>{}, rows);
}

// c <- c b^T for a b of 8 x 8: rows by one register at a time, all eight columns at once.
void multiply_in_place(int rows, const double* b, double* c, int ldc) {
    for (int i = 0; i < rows; i += lanes) tile<1, 8, Update::replace>(8, c + i, ldc, b, 8, c + i, ldc);
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
        if (rest > 0) multiply_in_place(rest, divisor.data(), at(l_, k + block, k), n);
        for (int j = k; j < k + block; ++j) l_signed_.col(j).tail(rows) = d_[j] * l_.col(j).tail(rows);
    }
    return true;
}

void SignedCholesky::solve_right(bool upper) {
    const int n = static_cast<int>(solved_.rows());
    for (int k = 0; k < n; k += block) {
        const int rows = upper ? k + block : n;
        rank_update<Update::subtract>(rows, k, solved_.data(), n, at(l_, k, 0), n, at(solved_, 0, k), n);
        multiply_in_place(rows, inverses_[k / block].data(), at(solved_, 0, k), n);
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
