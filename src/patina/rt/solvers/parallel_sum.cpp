#include "patina/rt/solvers/parallel_sum.h"

namespace patina::rt {

template <class Scalar>
typename Arithmetic<Scalar>::Matrix Arithmetic<Scalar>::inverse(const Matrix& a) const {
    return a.partialPivLu().inverse();
}

template <class Scalar>
typename Arithmetic<Scalar>::Matrix Arithmetic<Scalar>::parallel_difference(const Matrix& a, const Matrix& sum) const {
    Matrix result = a;
    result.noalias() -= a * sum.partialPivLu().solve(a);
    return result;
}

template class Arithmetic<double>;
template class Arithmetic<long double>;

}  // namespace patina::rt
