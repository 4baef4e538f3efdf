#include "patina/io/image_optics.h"

#include <cmath>

#include "patina/core/constants.h"

namespace patina::io {

namespace {

// Stokes components in axes turned counter-clockwise by the angle.
Eigen::Matrix4d frame_rotation(double angle_deg) {
    const double c = std::cos(2 * radians(angle_deg)), s = std::sin(2 * radians(angle_deg));
    Eigen::Matrix4d rotation = Eigen::Matrix4d::Identity();
    rotation.block<2, 2>(1, 1) << c, s, -s, c;
    return rotation;
}

Eigen::Matrix4d turned(const Eigen::Matrix4d& element, double angle_deg) {
    return frame_rotation(-angle_deg) * element * frame_rotation(angle_deg);
}

}  // namespace

Eigen::Matrix4d polarizer_mueller(double angle_deg) {
    Eigen::Matrix4d horizontal = Eigen::Matrix4d::Zero();
    horizontal.topLeftCorner<2, 2>().setConstant(0.5);
    return turned(horizontal, angle_deg);
}

Eigen::Matrix4d retarder_mueller(double fast_axis_deg, double retardance_deg) {
    const double c = std::cos(radians(retardance_deg)), s = std::sin(radians(retardance_deg));
    Eigen::Matrix4d horizontal = Eigen::Matrix4d::Identity();
    horizontal.bottomRightCorner<2, 2>() << c, s, -s, c;
    return turned(horizontal, fast_axis_deg);
}

StokesImage apply_mueller(StokesImage image, const Eigen::Matrix4d& mueller) {
    const Eigen::Matrix4f matrix = mueller.cast<float>();
    for (std::size_t i = 0; i + 4 <= image.spectral.size(); i += 4) {
        Eigen::Map<Eigen::Vector4f> stokes(&image.spectral[i]);
        stokes = (matrix * stokes).eval();
    }
    for (std::size_t i = 0; i + 12 <= image.rgb.size(); i += 12) {
        Eigen::Map<Eigen::Matrix<float, 4, 3, Eigen::RowMajor>> stokes(&image.rgb[i]);
        stokes = (matrix * stokes).eval();
    }
    image.variance.clear();
    return image;
}

}  // namespace patina::io
