#include "patina/brdf/once_scattered.h"

#include <algorithm>
#include <cmath>

#include "patina/brdf/interpolation.h"
#include "patina/brdf/meridian_frame.h"
#include "patina/core/constants.h"
#include "patina/math/path_integrals.h"
#include "patina/optics/scattering/expansion.h"

namespace patina::brdf {

using optics::Mueller;

namespace {

Mueller turned() {
    return Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
}

// Turns Stokes vectors from the frame (p, s) into one whose p lies at `p_new`, both across the propagation.
Mueller rotation(const MeridianFrame& frame, const Eigen::Vector3d& p_new) {
    const double c = p_new.dot(frame.p), s = p_new.dot(frame.s);
    const double c2 = c * c - s * s, s2 = 2 * c * s;
    Mueller result = Mueller::Identity();
    result.block<2, 2>(1, 1) << c2, s2, -s2, c2;
    return result;
}

Eigen::Array<double, 6, 1> direct(const optics::ExpansionCoefficients& scattering, double cosine) {
    const optics::ScatteringElements f = optics::evaluate(scattering, cosine);
    return {f.a1, f.a2, f.a3, f.a4, f.b1, f.b2};
}

}  // namespace

OnceScatteredLight::OnceScatteredLight(const OnceScattered& layer, std::span<const double> theta_deg,
                                       std::size_t evaluations)
    : layer_(layer), theta_deg_(theta_deg) {
    // Eight angles to the shortest wave of the matrix: a cubic errs by 6e-4 of that wave's small part.
    const int intervals = std::max(256, 8 * layer.scattering.order());
    if (4 * evaluations < static_cast<std::size_t>(intervals)) return;
    tabulated_.resize(6, intervals + 1);
    for (int k = 0; k <= intervals; ++k) tabulated_.col(k) = direct(layer.scattering, std::cos(pi * k / intervals));
}

Eigen::Array<double, 6, 1> OnceScatteredLight::elements(double cosine) const {
    if (tabulated_.cols() == 0) return direct(layer_.scattering, cosine);
    const auto last = static_cast<int>(tabulated_.cols()) - 1;
    const double x = std::acos(std::clamp(cosine, -1.0, 1.0)) / pi * last;
    const int first = std::clamp(static_cast<int>(x) - 1, 0, last - 3);
    const double t = x - first;  // Lagrange's cubic on 0, 1, 2, 3
    return -(t - 1) * (t - 2) * (t - 3) / 6 * tabulated_.col(first) +
           t * (t - 2) * (t - 3) / 2 * tabulated_.col(first + 1) -
           t * (t - 1) * (t - 3) / 2 * tabulated_.col(first + 2) +
           t * (t - 1) * (t - 2) / 6 * tabulated_.col(first + 3);
}

// From light at the signed cosine `from` and azimuth 0 to light at `to` and phi, both measured from the outward normal.
Mueller OnceScatteredLight::phase_matrix(double to, double from, double phi) const {
    const MeridianFrame in = meridian_frame(from, 0.0), out = meridian_frame(to, phi);
    Eigen::Vector3d across = in.propagation.cross(out.propagation);
    const double sine = across.norm();
    // Forward and backward every plane is one of scattering.
    across = sine > 1e-12 ? Eigen::Vector3d(across / sine) : in.s;
    const Eigen::Array<double, 6, 1> f = elements(in.propagation.dot(out.propagation));
    Mueller matrix;
    matrix << f[0], f[4], 0, 0, f[4], f[1], 0, 0, 0, 0, f[2], f[5], 0, 0, -f[5], f[3];
    return rotation(out, out.propagation.cross(across)).transpose() * matrix *
           rotation(in, in.propagation.cross(across));
}

OnceScatteredLight::Ray OnceScatteredLight::ray(double mu) const {
    const double n = layer_.index_ratio;
    Ray result{std::sqrt(std::max(0.0, 1 - (1 - mu) * (1 + mu) / (n * n))), Mueller::Zero(), Mueller::Zero()};
    const CubicInterval angle = cubic_interval(theta_deg_, degrees(std::acos(std::min(1.0, mu))));
    for (int k = 0; k < angle.count; ++k) {
        result.down += angle.weights[k] * layer_.down[angle.first + k];
        result.up += angle.weights[k] * layer_.up[angle.first + k];
    }
    return result;
}

Mueller OnceScatteredLight::operator()(double mu_o, double mu_i, double phi) const {
    const Ray in = ray(mu_i), out = ray(mu_o);
    if (in.mu < 1e-9 || out.mu < 1e-9) return Mueller::Zero();
    const double a = 1 / out.mu, b = 1 / in.mu;
    const double same_face = math::path_back(a, b, layer_.optical_thickness),
                 other_face = math::path_through(a, b, layer_.optical_thickness);
    const Mueller reversal = Eigen::Vector4d(1, 1, 1, -1).asDiagonal();
    const Mueller leave = turned() * reversal * out.down.transpose() * reversal * turned();
    Mueller result = leave * same_face * phase_matrix(out.mu, -in.mu, phi) * in.down;
    // Light that a mirror below turns round.
    if (!in.up.isZero(0.0) || !out.up.isZero(0.0)) {
        const Mueller up = turned() * in.up, mirrored = turned() * reversal * out.up.transpose() * reversal;
        result += leave * other_face * phase_matrix(out.mu, in.mu, phi) * up;
        result += mirrored * (other_face * phase_matrix(-out.mu, -in.mu, phi) * in.down +
                              same_face * phase_matrix(-out.mu, in.mu, phi) * up);
    }
    return result / (4 * pi * layer_.index_ratio * layer_.index_ratio * out.mu * in.mu);
}

}  // namespace patina::brdf
