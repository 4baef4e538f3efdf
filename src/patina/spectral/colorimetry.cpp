#include "patina/spectral/colorimetry.h"

#include <cmath>

#include "patina/core/contract.h"

namespace patina::spectral {

namespace {

constexpr int samples = 81;
constexpr double first_nm = 380.0, step_nm = 5.0;

// Sum of spectrum times colour matching functions, times the step.
Eigen::Vector3d integrate(const SpectralFunction& spectrum, Observer observer) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < samples; ++i) {
        const double wavelength_nm = first_nm + i * step_nm;
        sum += spectrum(wavelength_nm) * colour_matching(observer, wavelength_nm);
    }
    return sum * step_nm;
}

// XYZ of a chromaticity with Y = 1.
Eigen::Vector3d unit_luminance(double x, double y) {
    return {x / y, 1.0, (1.0 - x - y) / y};
}

// Columns: the primaries, scaled so that (1, 1, 1) is the white.
Eigen::Matrix3d srgb_primaries() {
    Eigen::Matrix3d primaries;
    primaries << unit_luminance(0.64, 0.33), unit_luminance(0.30, 0.60), unit_luminance(0.15, 0.06);
    const Eigen::Vector3d scale = primaries.inverse() * unit_luminance(0.3127, 0.3290);
    return primaries * scale.asDiagonal();
}

// The cube root of L*a*b*, straight below (6/29)^3.
constexpr double lab_corner = 6.0 / 29.0;
double lab_root(double t) {
    return t > lab_corner * lab_corner * lab_corner ? std::cbrt(t) : t / (3.0 * lab_corner * lab_corner) + 4.0 / 29.0;
}
double lab_cube(double f) {
    return f > lab_corner ? f * f * f : 3.0 * lab_corner * lab_corner * (f - 4.0 / 29.0);
}

}  // namespace

Eigen::Vector3d xyz_of_radiance(const SpectralFunction& radiance, Observer observer) {
    return integrate(radiance, observer) / integrate(Spectrum(1.0), observer)[1];
}

Eigen::Vector3d xyz_of_reflectance(const SpectralFunction& reflectance, const SpectralFunction& illuminant,
                                   Observer observer) {
    const double white_y = integrate(illuminant, observer)[1];
    PATINA_EXPECT(white_y > 0.0);
    const auto reflected = [&](double wavelength_nm) { return reflectance(wavelength_nm) * illuminant(wavelength_nm); };
    return integrate(reflected, observer) / white_y;
}

Eigen::Vector3d white_point(const SpectralFunction& illuminant, Observer observer) {
    return xyz_of_reflectance(Spectrum(1.0), illuminant, observer);
}

Eigen::Vector2d chromaticity(const Eigen::Vector3d& xyz) {
    const double sum = xyz.sum();
    if (sum == 0.0) return Eigen::Vector2d::Zero();
    return xyz.head<2>() / sum;
}

Eigen::Vector3d xyz_to_linear_srgb(const Eigen::Vector3d& xyz) {
    static const Eigen::Matrix3d matrix = srgb_primaries().inverse();
    return matrix * xyz;
}

Eigen::Vector3d linear_srgb_to_xyz(const Eigen::Vector3d& rgb) {
    static const Eigen::Matrix3d matrix = srgb_primaries();
    return matrix * rgb;
}

double srgb_encode(double linear) {
    const double a = std::abs(linear);
    return std::copysign(a <= 0.0031308 ? 12.92 * a : 1.055 * std::pow(a, 1.0 / 2.4) - 0.055, linear);
}

double srgb_decode(double encoded) {
    const double a = std::abs(encoded);
    return std::copysign(a <= 0.04045 ? a / 12.92 : std::pow((a + 0.055) / 1.055, 2.4), encoded);
}

Eigen::Vector3d xyz_to_lab(const Eigen::Vector3d& xyz, const Eigen::Vector3d& white) {
    PATINA_EXPECT(white.minCoeff() > 0.0);
    const double fx = lab_root(xyz[0] / white[0]), fy = lab_root(xyz[1] / white[1]), fz = lab_root(xyz[2] / white[2]);
    return {116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)};
}

Eigen::Vector3d lab_to_xyz(const Eigen::Vector3d& lab, const Eigen::Vector3d& white) {
    const double fy = (lab[0] + 16.0) / 116.0;
    return {white[0] * lab_cube(fy + lab[1] / 500.0), white[1] * lab_cube(fy),
            white[2] * lab_cube(fy - lab[2] / 200.0)};
}

Eigen::Matrix3d bradford_adaptation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    Eigen::Matrix3d cones;
    cones << 0.8951, 0.2664, -0.1614,  //
        -0.7502, 1.7135, 0.0367,       //
        0.0389, -0.0685, 1.0296;
    const Eigen::Vector3d gain = (cones * to).cwiseQuotient(cones * from);
    return cones.inverse() * gain.asDiagonal() * cones;
}

}  // namespace patina::spectral
