#include "patina/optics/scattering/mie.h"

#include <algorithm>
#include <cmath>

#include "patina/core/contract.h"

namespace patina::optics {

namespace {

using Complex = std::complex<double>;

// 1/z without the scaling of the general division; |z|^2 neither overflows nor underflows here.
inline Complex reciprocal(Complex z) {
    const double norm = z.real() * z.real() + z.imag() * z.imag();
    return {z.real() / norm, -z.imag() / norm};
}
inline double reciprocal(double x) {
    return 1.0 / x;
}

inline Complex times(Complex a, Complex b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

// First order of a downward recurrence whose error has died out at the turning point |z|: over 8 |z|^(1/3) orders the
// ratio Ai/Bi of the Airy functions falls below 1e-18.
int downward_start(double magnitude, int order) {
    const int beyond_turning_point = static_cast<int>(magnitude + 8.0 * std::cbrt(magnitude));
    return std::max(order, beyond_turning_point) + 15;
}

// psi_n(x) for n = 0 .. order (size order + 1); Number is complex in an absorbing host.
template <class Number>
void riccati_bessel_psi(Number x, int order, std::vector<Number>& psi) {
    // Recur the ratio psi_n / psi_{n-1} downward.
    psi.resize(order + 1);
    const Number inverse = reciprocal(x);
    Number ratio = 0.0;
    for (int n = downward_start(std::abs(x), order); n >= 1; --n) {
        ratio = reciprocal((2.0 * n + 1.0) * inverse - ratio);
        if (n <= order) psi[n] = ratio;
    }

    // Start the product at psi_0, or at psi_1 where psi_0 is near one of its zeros.
    psi[0] = std::sin(x);
    if (std::abs(x) < 1.0 || std::abs(psi[0]) > 0.5) {
        psi[1] *= psi[0];
    } else {
        psi[1] = psi[0] * inverse - std::cos(x);
    }
    for (int n = 2; n <= order; ++n) psi[n] *= psi[n - 1];
}

// D_n(z) = psi_n'(z)/psi_n(z) for n = 1 .. order (size order + 1, index 0 unused).
void logarithmic_derivative(Complex z, int order, std::vector<Complex>& derivative) {
    derivative.resize(order + 1);
    const int start = downward_start(std::abs(z), order);
    const Complex inverse = reciprocal(z);
    Complex d = (start + 1.0) * inverse;
    for (int n = start; n >= 1; --n) {
        if (n <= order) derivative[n] = d;
        const Complex n_over_z = static_cast<double>(n) * inverse;
        d = n_over_z - reciprocal(d + n_over_z);
    }
}

// The same for a real argument, where complex arithmetic would be wasted.
void logarithmic_derivative(double z, int order, std::vector<double>& derivative) {
    derivative.resize(order + 1);
    const int start = downward_start(z, order);
    double d = (start + 1.0) / z;
    for (int n = start; n >= 1; --n) {
        if (n <= order) derivative[n] = d;
        const double n_over_z = n / z;
        d = n_over_z - 1.0 / (d + n_over_z);
    }
}

// numerator / (numerator - i partner), the form of every a_n and b_n: psi-like over xi-like, xi = psi - i chi.
inline Complex multipole(double numerator, double partner) {
    const double norm = numerator * numerator + partner * partner;
    return {numerator * numerator / norm, numerator * partner / norm};
}
inline Complex multipole(Complex numerator, Complex partner) {
    return times(numerator, reciprocal({numerator.real() + partner.imag(), numerator.imag() - partner.real()}));
}

// a_n and b_n (Bohren & Huffman 1983, eq. 4.88) of a sphere in a host where it has the size parameter x; z = m x.
// `Inside` is double for a transparent sphere, `Outside` for a transparent host.
template <class Outside, class Inside, class Ratio>
void fill_multipoles(Outside x, Inside z, Ratio m, int order, std::vector<Complex>& a, std::vector<Complex>& b) {
    std::vector<Outside> psi;
    std::vector<Inside> derivative;
    riccati_bessel_psi(x, order, psi);
    logarithmic_derivative(z, order, derivative);

    a.resize(order);
    b.resize(order);
    const Ratio inverse_m = reciprocal(m);
    const Outside inverse_x = reciprocal(x);
    Outside chi_previous = std::cos(x);
    Outside chi = chi_previous * inverse_x + std::sin(x);
    for (int n = 1; n <= order; ++n) {
        const Outside n_over_x = static_cast<double>(n) * inverse_x;
        const Ratio electric = derivative[n] * inverse_m + n_over_x;
        const Ratio magnetic = derivative[n] * m + n_over_x;
        a[n - 1] = multipole(electric * psi[n] - psi[n - 1], electric * chi - chi_previous);
        b[n - 1] = multipole(magnetic * psi[n] - psi[n - 1], magnetic * chi - chi_previous);
        const Outside chi_next = (2.0 * n + 1.0) * inverse_x * chi - chi_previous;
        chi_previous = chi;
        chi = chi_next;
    }
}

}  // namespace

int mie_order(double size_parameter) {
    return static_cast<int>(size_parameter + 4.5 * std::cbrt(size_parameter) + 5.0);
}

MieSphere::MieSphere(double size_parameter, Complex relative_index) : size_parameter_(size_parameter) {
    PATINA_EXPECT(size_parameter >= 1e-20 && relative_index.real() > 0.0 && relative_index.imag() >= 0.0);
    PATINA_EXPECT(size_parameter * std::max(1.0, std::abs(relative_index)) <= 1e6);
    const int order = mie_order(size_parameter);
    if (relative_index.imag() == 0.0) {
        const double m = relative_index.real();
        fill_multipoles(size_parameter, m * size_parameter, m, order, a_, b_);
    } else {
        fill_multipoles(size_parameter, relative_index * size_parameter, relative_index, order, a_, b_);
    }
    sum_efficiencies();
    if (relative_index.imag() == 0.0) absorption_efficiency_ = 0.0;
}

MieSphere MieSphere::in_absorbing_host(Complex x, Complex m) {
    PATINA_EXPECT(std::abs(x) >= 1e-20 && x.real() > 0.0 && x.imag() >= 0.0 && x.imag() <= max_host_absorption);
    const Complex z = m * x;
    PATINA_EXPECT(z.real() > 0.0 && std::max(std::abs(x), std::abs(z)) <= 1e6);
    MieSphere sphere;
    sphere.size_parameter_ = x.real();
    fill_multipoles(x, Complex(z.real(), std::max(0.0, z.imag())), m, mie_order(std::abs(x)), sphere.a_, sphere.b_);
    sphere.sum_efficiencies();

    // Take the efficiencies from the coherent field and the far field: k is complex where the host absorbs.
    double extinction = 0.0, scattering = 0.0, absorption = 0.0;
    const Complex inverse_x2 = 1.0 / (x * x);
    for (int n = sphere.order(); n >= 1; --n) {
        const Complex a = sphere.a_[n - 1], b = sphere.b_[n - 1];
        const double out = (2 * n + 1) * times(a + b, inverse_x2).real();
        const double scattered = (2 * n + 1) * (std::norm(a) + std::norm(b)) / std::norm(x);
        extinction += out;
        scattering += scattered;
        absorption += out - scattered;
    }
    sphere.extinction_efficiency_ = 2.0 * extinction;
    sphere.scattering_efficiency_ = 2.0 * scattering;
    sphere.absorption_efficiency_ = 2.0 * absorption;
    sphere.backscattering_efficiency_ *= x.real() * x.real() / std::norm(x);
    return sphere;
}

// The limit |m| -> infinity: a_n = psi_n'/xi_n', b_n = psi_n/xi_n.
MieSphere MieSphere::perfect_conductor(double x) {
    PATINA_EXPECT(x >= 1e-20 && x <= 1e6);
    MieSphere sphere;
    sphere.size_parameter_ = x;
    const int order = mie_order(x);
    std::vector<double> psi;
    riccati_bessel_psi(x, order, psi);
    double chi_previous = std::cos(x);
    double chi = chi_previous / x + std::sin(x);
    for (int n = 1; n <= order; ++n) {
        sphere.a_.push_back(multipole(psi[n - 1] - n / x * psi[n], chi_previous - n / x * chi));
        sphere.b_.push_back(multipole(psi[n], chi));
        const double chi_next = (2 * n + 1) / x * chi - chi_previous;
        chi_previous = chi;
        chi = chi_next;
    }
    sphere.sum_efficiencies();
    sphere.absorption_efficiency_ = 0.0;
    return sphere;
}

// Bohren & Huffman (1983), eqs 4.61, 4.62, 4.82 and section 4.5 (asymmetry).
void MieSphere::sum_efficiencies() {
    double extinction = 0.0, scattering = 0.0, absorption = 0.0, forwardness = 0.0;
    Complex backward = 0.0;
    for (int n = order(); n >= 1; --n) {
        const Complex a = a_[n - 1], b = b_[n - 1];
        extinction += (2 * n + 1) * (a.real() + b.real());
        scattering += (2 * n + 1) * (std::norm(a) + std::norm(b));
        absorption += (2 * n + 1) * ((a.real() - std::norm(a)) + (b.real() - std::norm(b)));
        backward += (n % 2 == 0 ? 1.0 : -1.0) * (2 * n + 1) * (a - b);
        forwardness += (2.0 * n + 1) / (n * (n + 1.0)) * (a.real() * b.real() + a.imag() * b.imag());
        if (n < order()) {
            const Complex a_next = a_[n], b_next = b_[n];
            forwardness += n * (n + 2.0) / (n + 1.0) *
                           (a.real() * a_next.real() + a.imag() * a_next.imag() + b.real() * b_next.real() +
                            b.imag() * b_next.imag());
        }
    }
    const double inverse_x2 = 1.0 / (size_parameter_ * size_parameter_);
    extinction_efficiency_ = 2.0 * inverse_x2 * extinction;
    scattering_efficiency_ = 2.0 * inverse_x2 * scattering;
    absorption_efficiency_ = 2.0 * inverse_x2 * std::max(absorption, 0.0);
    backscattering_efficiency_ = inverse_x2 * std::norm(backward);
    asymmetry_ = scattering > 0.0 ? 2.0 * forwardness / scattering : 0.0;
}

MieAmplitudes MieSphere::amplitudes(std::span<const double> cosines) const {
    // Weight the multipoles.
    Eigen::MatrixX2d sum(order(), 2), difference(order(), 2);
    for (int n = 1; n <= order(); ++n) {
        const double factor = (2.0 * n + 1) / (n * (n + 1.0));
        const Complex s = factor * (a_[n - 1] + b_[n - 1]), d = factor * (a_[n - 1] - b_[n - 1]);
        sum.row(n - 1) << s.real(), s.imag();
        difference.row(n - 1) << d.real(), d.imag();
    }

    // Sum them at a few angles at a time, so that memory stays small.
    constexpr std::size_t block = 64;
    const auto count = static_cast<Eigen::Index>(cosines.size());
    MieAmplitudes amplitudes{Eigen::ArrayXcd(count), Eigen::ArrayXcd(count)};
    for (std::size_t begin = 0; begin < cosines.size(); begin += block) {
        const auto angles = cosines.subspan(begin, std::min(block, cosines.size() - begin));
        const MieAngularFunctions f = mie_angular_functions(angles, order());
        const Eigen::MatrixX2d plus = f.sum * sum, minus = f.difference * difference;
        for (Eigen::Index i = 0; i < plus.rows(); ++i) {
            const Complex p(plus(i, 0), plus(i, 1)), q(minus(i, 0), minus(i, 1));
            amplitudes.s1[begin + i] = 0.5 * (p + q);
            amplitudes.s2[begin + i] = 0.5 * (p - q);
        }
    }
    return amplitudes;
}

MieAngularFunctions mie_angular_functions(std::span<const double> cosines, int order) {
    PATINA_EXPECT(order >= 1);
    const auto count = static_cast<Eigen::Index>(cosines.size());
    MieAngularFunctions f{Eigen::MatrixXd(count, order), Eigen::MatrixXd(count, order)};
    const Eigen::Map<const Eigen::ArrayXd> mu(cosines.data(), count);
    Eigen::ArrayXd previous = Eigen::ArrayXd::Zero(count), pi_n = Eigen::ArrayXd::Ones(count);
    Eigen::ArrayXd product(count), step(count), tau(count);
    for (int n = 1; n <= order; ++n) {
        // Wiscombe (1980), eqs 26-27.
        product = mu * pi_n;
        step = product - previous;
        tau = n * step - previous;
        f.sum.col(n - 1) = pi_n + tau;
        f.difference.col(n - 1) = pi_n - tau;
        previous = pi_n;
        pi_n = product + (n + 1.0) / n * step;
    }
    return f;
}

}  // namespace patina::optics
