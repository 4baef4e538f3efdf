#include "patina/rt/solvers/parallel_sum.h"

#include <type_traits>

#include "patina/rt/solvers/signed_cholesky.h"

namespace patina::rt {

template <class Scalar>
typename Arithmetic<Scalar>::Matrix Arithmetic<Scalar>::inverse(const Matrix& a) const {
    if constexpr (std::is_same_v<Scalar, double>) {
        SignedCholesky cholesky;
        if (symmetric_ && cholesky.compute(a, signature_)) return cholesky.inverse();
    }
    return a.partialPivLu().inverse();
}

template <class Scalar>
typename Arithmetic<Scalar>::Matrix Arithmetic<Scalar>::parallel_difference(const Matrix& a, const Matrix& sum,
                                                                            Scalar factor) const {
    Matrix result;
    if constexpr (std::is_same_v<Scalar, double>) {
        SignedCholesky cholesky;
        if (symmetric_ && cholesky.compute(sum, signature_)) {
            cholesky.parallel_difference(a, factor, result);
            return result;
        }
    }
    result = factor * a;
    result.noalias() -= (factor * a) * sum.partialPivLu().solve(a);
    return result;
}

template class Arithmetic<double>;
template class Arithmetic<long double>;

}  // namespace patina::rt
