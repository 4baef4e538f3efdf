#include "patina/spectral/rgb_upsampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "patina/core/contract.h"
#include "patina/spectral/colorimetry.h"
#include "patina/spectral/illuminants.h"

namespace patina::spectral {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int samples = 81;
constexpr double first_nm = 380.0, step_nm = 5.0;

double scaled_wavelength(double wavelength_nm) {
    return (wavelength_nm - 595.0) / 235.0;
}

double sigmoid(double x) {
    if (std::isinf(x)) return x > 0.0 ? 1.0 : 0.0;
    return 0.5 + 0.5 * x / std::sqrt(1.0 + x * x);
}

// The x with sigmoid(x) = value; infinite at 0 and 1.
double inverse_sigmoid(double value) {
    if (value <= 0.0) return -std::numeric_limits<double>::infinity();
    if (value >= 1.0) return std::numeric_limits<double>::infinity();
    return (value - 0.5) / std::sqrt(value * (1.0 - value));
}

// What one wavelength of a reflectance contributes to linear sRGB under D65.
std::array<Vector3d, samples> rgb_weights() {
    const Spectrum d65 = illuminant_d65();
    std::array<Vector3d, samples> weights;
    double y = 0.0;
    for (int i = 0; i < samples; ++i) {
        const double wavelength_nm = first_nm + i * step_nm;
        weights[i] = d65(wavelength_nm) * colour_matching(Observer::cie1931_2deg, wavelength_nm);
        y += weights[i][1];
    }
    for (Vector3d& weight : weights) weight = xyz_to_linear_srgb(weight) / y;
    return weights;
}

// Colour of the reflectance with these coefficients, and its derivatives by them.
Vector3d colour_of(const Vector3d& coefficients, Matrix3d& jacobian) {
    static const std::array<Vector3d, samples> weights = rgb_weights();
    Vector3d colour = Vector3d::Zero();
    jacobian.setZero();
    for (int i = 0; i < samples; ++i) {
        const double t = scaled_wavelength(first_nm + i * step_nm);
        const Vector3d powers(t * t, t, 1.0);
        const double x = coefficients.dot(powers), root = std::sqrt(1.0 + x * x);
        colour += weights[i] * (0.5 + 0.5 * x / root);
        jacobian += weights[i] * powers.transpose() * (0.5 / (root * root * root));
    }
    return colour;
}

// Gauss-Newton with Levenberg's damping, from `coefficients` towards the colour `target`.
Vector3d solve_for(const Vector3d& target, Vector3d coefficients) {
    constexpr int most_iterations = 60;
    constexpr double close_enough = 1e-5;  // a hundredth of what is promised
    Matrix3d jacobian, trial_jacobian;
    Vector3d residual = colour_of(coefficients, jacobian) - target;
    double damping = 1e-3;
    for (int i = 0; i < most_iterations && residual.norm() > close_enough; ++i) {
        Matrix3d normal = jacobian.transpose() * jacobian;
        normal.diagonal() *= 1.0 + damping;
        normal.diagonal().array() += 1e-14;
        const Vector3d trial = coefficients - normal.ldlt().solve(jacobian.transpose() * residual);
        const Vector3d trial_residual = colour_of(trial, trial_jacobian) - target;
        if (trial_residual.norm() < residual.norm()) {
            coefficients = trial;
            residual = trial_residual;
            jacobian = trial_jacobian;
            damping = std::max(0.2 * damping, 1e-12);
        } else {
            damping = std::min(5.0 * damping, 1e12);
        }
    }
    return coefficients;
}

}  // namespace

double SigmoidReflectance::operator()(double wavelength_nm) const {
    const double t = scaled_wavelength(wavelength_nm);
    return sigmoid((coefficients_[0] * t + coefficients_[1]) * t + coefficients_[2]);
}

SigmoidReflectance upsampled_reflectance(const Vector3d& rgb) {
    PATINA_EXPECT(rgb.allFinite());
    const Vector3d target = rgb.cwiseMax(0.0).cwiseMin(1.0);
    const double grey = target.mean();
    if (target.maxCoeff() - target.minCoeff() < 1e-9)
        return SigmoidReflectance(Vector3d(0.0, 0.0, inverse_sigmoid(grey)));

    // Walk from the grey of the same mean to the colour: saturated colours are out of reach of one leap.
    constexpr int steps = 6;
    Vector3d coefficients(0.0, 0.0, inverse_sigmoid(grey));
    for (int step = 1; step <= steps; ++step) {
        const double s = static_cast<double>(step) / steps;
        coefficients = solve_for(Vector3d::Constant((1.0 - s) * grey) + s * target, coefficients);
    }
    return SigmoidReflectance(coefficients);
}

SpectralFunction upsampled_emission(const Vector3d& rgb) {
    PATINA_EXPECT(rgb.allFinite());
    const Spectrum d65 = illuminant_d65();
    const Spectrum white = d65.scaled(1.0 / xyz_of_radiance(d65)[1]);

    // Twice the largest channel leaves the reflectance room: bright saturated colours have smooth spectra only below 1.
    const double scale = 2.0 * rgb.maxCoeff();
    if (scale <= 0.0) return Spectrum(0.0);
    return [white, scale, shape = upsampled_reflectance(rgb / scale)](double wavelength_nm) {
        return scale * shape(wavelength_nm) * white(wavelength_nm);
    };
}

}  // namespace patina::spectral
