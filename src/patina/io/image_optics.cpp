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

Bitmap polarization_mosaic(const StokesPlane& plane) {
    constexpr double angles_deg[2][2] = {{90, 45}, {135, 0}};
    Eigen::Vector4f analyser[2][2];
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 2; ++column)
            analyser[row][column] = polarizer_mueller(angles_deg[row][column]).row(0).transpose().cast<float>();
    Bitmap sensor{"", plane.width, plane.height, {"Y"}, {}};
    sensor.data.reserve(plane.pixels.size());
    for (int y = 0; y < plane.height; ++y)
        for (int x = 0; x < plane.width; ++x)
            sensor.data.push_back(
                analyser[y % 2][x % 2].dot(plane.pixels[static_cast<std::size_t>(y) * plane.width + x]));
    return sensor;
}

}  // namespace patina::io
