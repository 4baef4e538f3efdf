#pragma once
// A ray with an explicit electric-field frame, and what rotations, diagonal Jones matrices and scattering do to its
// Stokes vectors.
//
// Frame: unit vectors k (propagation), p, s with s x p = k. Stokes: I = |Ep|^2+|Es|^2, Q = |Ep|^2-|Es|^2, U = 2 Re(Ep
// Es*), V = -2 Im(Ep Es*), time factor exp(-i w t). z points up, out of the stack. The meridian frame has p = +e_theta,
// s = -e_phi.

#include <cmath>
#include <complex>

#include <Eigen/Dense>

namespace patina::rt::monte_carlo {

using Complex = std::complex<double>;
using Vector = Eigen::Vector3d;

// Columns are the responses to several incident Stokes vectors carried along one path; columns == 1 is an ordinary
// packet.
template <int columns>
using StokesColumns = Eigen::Matrix<double, 4, columns>;

struct Frame {
    Vector k, p, s;
};

// Meridian frame of a direction with k_z = cosine and the azimuth of a horizontal unit vector.
inline Frame meridian_frame(double cosine, double cos_azimuth, double sin_azimuth) {
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return {{sine * cos_azimuth, sine * sin_azimuth, cosine},
            {cosine * cos_azimuth, cosine * sin_azimuth, -sine},
            {sin_azimuth, -cos_azimuth, 0.0}};
}

// cos and sin of twice the angle by which a frame turns about k.
struct DoubleAngle {
    double cosine, sine;
};

// The turn that takes p to cos p + sin s, from the components (x, y) along p and s of any multiple of the new p.
inline DoubleAngle double_angle(double x, double y, double inverse_square) {
    return {(x * x - y * y) * inverse_square, 2.0 * x * y * inverse_square};
}

// Stokes vectors in the frame turned by the angle: p' = cos p + sin s.
template <int columns>
[[gnu::always_inline]] inline void rotate(StokesColumns<columns>& stokes, const DoubleAngle& turn) {
    for (int c = 0; c < columns; ++c) {
        const double q = stokes(1, c), u = stokes(2, c);
        stokes(1, c) = turn.cosine * q + turn.sine * u;
        stokes(2, c) = turn.cosine * u - turn.sine * q;
    }
}

// An incoherent sum of diagonal Jones matrices diag(jp, js): pp = sum |jp|^2, ss = sum |js|^2, cross = sum jp js*.
// Such matrices multiply and add element by element, so that multiple reflection is scalar algebra.
struct Gain {
    double pp = 0.0, ss = 0.0;
    Complex cross = 0.0;

    bool is_zero() const { return pp == 0.0 && ss == 0.0; }
    // The same matrices once more, and `count` times.
    friend Gain operator*(const Gain& a, const Gain& b) { return {a.pp * b.pp, a.ss * b.ss, a.cross * b.cross}; }
    Gain power(double count) const { return {std::pow(pp, count), std::pow(ss, count), std::pow(cross, count)}; }
    static Gain of(Complex jp, Complex js) { return {std::norm(jp), std::norm(js), jp * std::conj(js)}; }
    friend Gain operator*(double factor, const Gain& g) { return {factor * g.pp, factor * g.ss, factor * g.cross}; }
};

// Ep Es* = (U - i V)/2 is multiplied by cross.
template <int columns>
[[gnu::always_inline]] inline void apply(const Gain& gain, StokesColumns<columns>& stokes) {
    const double mean = 0.5 * (gain.pp + gain.ss), half_difference = 0.5 * (gain.pp - gain.ss);
    const double re = gain.cross.real(), im = gain.cross.imag();
    for (int c = 0; c < columns; ++c) {
        const double i = stokes(0, c), q = stokes(1, c), u = stokes(2, c), v = stokes(3, c);
        stokes(0, c) = mean * i + half_difference * q;
        stokes(1, c) = half_difference * i + mean * q;
        stokes(2, c) = re * u + im * v;
        stokes(3, c) = re * v - im * u;
    }
}

}  // namespace patina::rt::monte_carlo
