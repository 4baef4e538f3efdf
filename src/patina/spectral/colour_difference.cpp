#include "patina/spectral/colour_difference.h"

#include <cmath>

#include "patina/core/constants.h"

namespace patina::spectral {

namespace {

double seventh_power_ratio(double chroma) {
    const double c7 = std::pow(chroma, 7), reference = std::pow(25.0, 7);
    return std::sqrt(c7 / (c7 + reference));
}

// Hue angle in [0, 360) degrees, 0 for a colour without hue.
double hue_deg(double a, double b) {
    if (a == 0.0 && b == 0.0) return 0.0;
    const double h = degrees(std::atan2(b, a));
    return h < 0.0 ? h + 360.0 : h;
}

double cos_deg(double angle) {
    return std::cos(radians(angle));
}

}  // namespace

double delta_e_76(const Eigen::Vector3d& lab_1, const Eigen::Vector3d& lab_2) {
    return (lab_1 - lab_2).norm();
}

double delta_e_2000(const Eigen::Vector3d& lab_1, const Eigen::Vector3d& lab_2) {
    // Stretch a* of nearly neutral colours (equations 2 to 7).
    const double mean_chroma_ab = 0.5 * (std::hypot(lab_1[1], lab_1[2]) + std::hypot(lab_2[1], lab_2[2]));
    const double stretch = 1.0 + 0.5 * (1.0 - seventh_power_ratio(mean_chroma_ab));
    const double a1 = stretch * lab_1[1], a2 = stretch * lab_2[1];
    const double c1 = std::hypot(a1, lab_1[2]), c2 = std::hypot(a2, lab_2[2]);
    const double h1 = hue_deg(a1, lab_1[2]), h2 = hue_deg(a2, lab_2[2]);

    // Take the differences, that of hue along the shorter way round (equations 8 to 11).
    const bool has_hue = c1 * c2 != 0.0;
    double dh = has_hue ? h2 - h1 : 0.0;
    if (dh > 180.0) dh -= 360.0;
    if (dh < -180.0) dh += 360.0;
    const double d_lightness = lab_2[0] - lab_1[0], d_chroma = c2 - c1;
    const double d_hue = 2.0 * std::sqrt(c1 * c2) * std::sin(radians(0.5 * dh));

    // Take the means, that of hue between the nearer two (equations 12 to 14).
    const double lightness = 0.5 * (lab_1[0] + lab_2[0]), chroma = 0.5 * (c1 + c2);
    double hue = h1 + h2;
    if (has_hue) {
        if (std::abs(h1 - h2) > 180.0) hue += hue < 360.0 ? 360.0 : -360.0;
        hue *= 0.5;
    }

    // Weight the differences (equations 15 to 21).
    const double t = 1.0 - 0.17 * cos_deg(hue - 30.0) + 0.24 * cos_deg(2.0 * hue) + 0.32 * cos_deg(3.0 * hue + 6.0) -
                     0.20 * cos_deg(4.0 * hue - 63.0);
    const double rotation_deg = 30.0 * std::exp(-std::pow((hue - 275.0) / 25.0, 2));
    const double l50 = (lightness - 50.0) * (lightness - 50.0);
    const double s_l = 1.0 + 0.015 * l50 / std::sqrt(20.0 + l50);
    const double s_c = 1.0 + 0.045 * chroma, s_h = 1.0 + 0.015 * chroma * t;
    const double r_t = -std::sin(radians(2.0 * rotation_deg)) * 2.0 * seventh_power_ratio(chroma);

    // Combine (equation 22).
    const double l = d_lightness / s_l, c = d_chroma / s_c, h = d_hue / s_h;
    return std::sqrt(l * l + c * c + h * h + r_t * c * h);
}

}  // namespace patina::spectral
