#include "patina/rt/solvers/tanh_doubling.h"

#include <cmath>
#include <limits>

#include "patina/core/contract.h"
#include "patina/rt/solvers/parallel_sum.h"
#include "patina/rt/solvers/signed_cholesky.h"

namespace patina::rt {

namespace {

template <class Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

template <class Scalar>
struct TanhCoth {
    Matrix<Scalar> x, u;
    Matrix<Scalar> sum;  // scratch
};

// Thin layer of half thickness h: the fifth convergent of tanh z = z/(1 + z^2/(3 + z^2/(5 + ...))), relative error
// 1e-7 z^10, and its reciprocal. With (a : b) the parallel sum 1/(1/a + 1/b), e = h H (may be singular) and g = (h
// G)^-1, X = (e : 3g + (e/5 : 7g + e/9)) and U = g + (e/3 : 5g + (e/7 : 9g)).
template <class Scalar>
TanhCoth<Scalar> thin_layer(const TransferSystem<Scalar>& system, Scalar h, Arithmetic<Scalar>& arithmetic) {
    const auto part = [](int k) { return Scalar(1) / Scalar(k); };
    const Matrix<Scalar> e = h * system.h;
    Matrix<Scalar> g = h * system.g;
    arithmetic.invert(g);
    TanhCoth<Scalar> t;
    t.x = part(5) * e;
    t.sum = 7 * g + (part(9) + part(5)) * e;
    arithmetic.parallel_difference(t.x, t.sum, 1);
    t.sum = 3 * g + t.x + e;
    t.x = e;
    arithmetic.parallel_difference(t.x, t.sum, 1);

    t.u = part(7) * e;
    t.sum = 9 * g + t.u;
    arithmetic.parallel_difference(t.u, t.sum, 1);
    t.sum = 5 * g + t.u + part(3) * e;
    t.u = part(3) * e;
    arithmetic.parallel_difference(t.u, t.sum, 1);
    t.u += g;
    return t;
}

template <class Scalar>
void double_thickness(TanhCoth<Scalar>& t, const TransferSystem<Scalar>& system, Arithmetic<Scalar>& arithmetic) {
    t.sum = t.x + t.u;
    arithmetic.parallel_difference(t.x, t.sum, 2);
    t.u = Scalar(0.5) * t.sum;

    // Keep a conservative layer so: rounding errors of X isotropic = 0 and flux^T X = 0 would double with the
    // thickness.
    if (system.isotropic.size() > 0) {
        const Scalar norm = system.flux.dot(system.isotropic);
        t.x -= (t.x * system.isotropic).eval() * (system.flux.transpose() / norm);
        t.x -= (system.isotropic / norm) * (system.flux.transpose() * t.x).eval();
    }
}

// Doublings that bring the start within reach. The start's relative error is 1e-7 (z 2^-k)^10 for a mode of half
// thickness z, of which a layer shows z/sinh 2z, most at z = 5.5; and the doubling contracts whatever error the
// saturated modes of larger z have if they start below z = 3.
int doublings(double half_thickness, double smallest_mu) {
    const double z = half_thickness / smallest_mu, worst = std::min(z, 5.5);
    const double error = 1e-7 * std::pow(worst, 10) * 2 * worst / std::sinh(2 * worst);
    const double steps = std::max(std::log2(error / 1e-16) / 10, std::log2(z / 3.0));
    return std::max(0, static_cast<int>(std::ceil(steps)));
}

// Removes from U the mode that decays only as 1/thickness in a conservative layer: with Y = 1/U growing by s a b^T, the
// limit of 1/(Y + s a b^T) for s to infinity.
template <class Scalar>
void saturate_conservative(TanhCoth<Scalar>& t, const TransferSystem<Scalar>& system) {
    const auto right = (t.u * system.isotropic).eval();
    const auto left = (system.flux.transpose() * t.u).eval();
    const Scalar norm = system.flux.dot(right);
    t.u -= right * left / norm;
}

template <class Scalar>
TanhCoth<Scalar> semi_infinite(const TransferSystem<Scalar>& system, const CancelToken* cancel,
                               Arithmetic<Scalar>& arithmetic) {
    constexpr int most_doublings = 80;
    TanhCoth<Scalar> t = thin_layer<Scalar>(system, Scalar(0.28) * Scalar(system.smallest_mu), arithmetic);
    for (int step = 0; step < most_doublings; ++step) {
        stop_if_requested(cancel);
        const Matrix<Scalar> before = t.x;
        double_thickness(t, system, arithmetic);
        const Scalar change = (t.x - before).cwiseAbs().maxCoeff() / t.x.cwiseAbs().maxCoeff();
        if (change <= 4 * std::numeric_limits<Scalar>::epsilon()) break;
    }
    if (system.isotropic.size() > 0) saturate_conservative(t, system);
    return t;
}

// Adds unknowns that neither scatter nor couple, until the size is a multiple of the block of the factorization.
template <class Scalar>
TransferSystem<Scalar> padded(const TransferSystem<Scalar>& system, int size) {
    TransferSystem<Scalar> result = system;
    const int n = system.size();
    for (auto* matrix : {&result.h, &result.g}) matrix->setIdentity(size, size);
    result.h.topLeftCorner(n, n) = system.h;
    result.g.topLeftCorner(n, n) = system.g;
    result.signature.setOnes(size);
    result.signature.head(n) = system.signature;
    result.quadrature = size;
    for (auto* vector : {&result.isotropic, &result.flux})
        if (vector->size() > 0) {
            vector->conservativeResize(size);
            vector->tail(size - n).setZero();
        }
    return result;
}

template <class Scalar>
LayerOperators<Scalar> solve(const TransferSystem<Scalar>& system, const LayerRequest& request) {
    Arithmetic<Scalar> arithmetic(system.signature, system.symmetric());
    const bool infinite = std::isinf(request.optical_thickness);
    TanhCoth<Scalar> t;
    if (infinite) {
        t = semi_infinite(system, request.cancel, arithmetic);
    } else {
        const double half = 0.5 * request.optical_thickness;
        const int steps = doublings(half, system.smallest_mu);
        t = thin_layer<Scalar>(system, std::ldexp(Scalar(half), -steps), arithmetic);
        for (int step = 0; step < steps; ++step) {
            stop_if_requested(request.cancel);
            double_thickness(t, system, arithmetic);
        }
    }

    stop_if_requested(request.cancel);
    // In the signed matrices: reflection P = 1/(P + X) + 1/(P + U) - P, transmission P = 1/(P + X) - 1/(P + U).
    t.x.diagonal() += system.signature;
    t.u.diagonal() += system.signature;
    arithmetic.invert(t.x);
    arithmetic.invert(t.u);
    LayerOperators<Scalar> result;
    result.reflection = (t.x + t.u) * system.signature.asDiagonal();
    result.reflection.diagonal().array() -= Scalar(1);
    if (request.transmission && !infinite) result.transmission = (t.x - t.u) * system.signature.asDiagonal();
    return result;
}

}  // namespace

template <class Scalar>
LayerOperators<Scalar> tanh_doubling(const TransferSystem<Scalar>& system, const LayerRequest& request) {
    PATINA_EXPECT(request.optical_thickness > 0.0);
    const int n = system.size(), block = SignedCholesky::block, size = (n + block - 1) / block * block;
    if (!system.symmetric() || size == n) return solve(system, request);
    LayerOperators<Scalar> result = solve(padded(system, size), request);
    result.reflection.conservativeResize(n, n);
    if (result.transmission.size() > 0) result.transmission.conservativeResize(n, n);
    return result;
}

template LayerOperators<double> tanh_doubling(const TransferSystem<double>&, const LayerRequest&);
template LayerOperators<long double> tanh_doubling(const TransferSystem<long double>&, const LayerRequest&);

}  // namespace patina::rt
