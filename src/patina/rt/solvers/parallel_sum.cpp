#include "patina/rt/solvers/parallel_sum.h"

#include <type_traits>

namespace patina::rt {

template <class Scalar>
void Arithmetic<Scalar>::invert(Matrix& a) {
    if constexpr (std::is_same_v<Scalar, double>) {
        if (symmetric_ && cholesky_.compute(a, signature_)) {
            cholesky_.inverse(a);
            return;
        }
    }
    a = a.partialPivLu().inverse().eval();
}

template <class Scalar>
void Arithmetic<Scalar>::parallel_difference(Matrix& a, const Matrix& sum, Scalar factor) {
    if constexpr (std::is_same_v<Scalar, double>) {
        if (symmetric_ && cholesky_.compute(sum, signature_)) {
            cholesky_.parallel_difference(a, factor);
            return;
        }
    }
    const Matrix share = a * sum.partialPivLu().solve(a);
    a = factor * (a - share);
}

template class Arithmetic<double>;
template class Arithmetic<long double>;

}  // namespace patina::rt
