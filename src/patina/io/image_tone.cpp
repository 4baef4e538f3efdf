#include "patina/io/image_tone.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "patina/core/contract.h"
#include "patina/io/image_colormap.h"
#include "patina/spectral/colorimetry.h"

namespace patina::io {

namespace {

// Where the curve leaves the identity.
constexpr double shoulder = 0.6;

double luminance(const Eigen::Vector3d& rgb) {
    return spectral::linear_srgb_to_xyz(rgb)[1];
}

Eigen::Vector3d s0_of(const StokesImage& image, std::size_t pixel) {
    return Eigen::Map<const Eigen::Vector3f>(image.stokes_rgb(pixel)).cast<double>();
}

Eigen::Vector3d mean_color(const StokesImage& image) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
        if (const Eigen::Vector3d rgb = s0_of(image, pixel); rgb.allFinite()) sum += rgb.cwiseMax(0.0);
    return sum;
}

WhiteBalance balance_of_the_light(const StokesImage& image) {
    const auto white = image.metadata.find("white");
    const bool uniform = white == image.metadata.end() ? image.bin_count() > 0 : white->second == "E";
    return uniform ? WhiteBalance::equal_energy : WhiteBalance::none;
}

// Linear sRGB to linear sRGB.
Eigen::Matrix3d balance_matrix(const StokesImage& image, WhiteBalance balance) {
    if (balance == WhiteBalance::automatic) balance = balance_of_the_light(image);
    if (balance == WhiteBalance::none) return Eigen::Matrix3d::Identity();
    Eigen::Vector3d white = Eigen::Vector3d::Ones();  // XYZ of a uniform spectrum
    if (balance == WhiteBalance::grey_world) {
        const Eigen::Vector3d mean = spectral::linear_srgb_to_xyz(mean_color(image));
        if (!(mean.minCoeff() > 0)) return Eigen::Matrix3d::Identity();
        white = mean / mean[1];
    }
    const Eigen::Vector3d screen = spectral::linear_srgb_to_xyz(Eigen::Vector3d::Ones());
    const Eigen::Matrix3d adaptation = spectral::bradford_adaptation(white, screen);
    Eigen::Matrix3d matrix;
    for (int c = 0; c < 3; ++c)
        matrix.col(c) =
            spectral::xyz_to_linear_srgb(adaptation * spectral::linear_srgb_to_xyz(Eigen::Vector3d::Unit(c)));
    return matrix;
}

// Draws the colour to the grey of the same luminance until it lies in the unit cube.
Eigen::Vector3d into_gamut(const Eigen::Vector3d& rgb, double grey) {
    double share = 1.0;
    for (int c = 0; c < 3; ++c) {
        if (rgb[c] > 1) share = std::min(share, (1 - grey) / (rgb[c] - grey));
        if (rgb[c] < 0) share = std::min(share, grey / (grey - rgb[c]));
    }
    return (Eigen::Vector3d::Constant(grey) + share * (rgb - Eigen::Vector3d::Constant(grey)))
        .cwiseMax(0.0)
        .cwiseMin(1.0);
}

}  // namespace

double automatic_exposure_ev(const StokesImage& image, WhiteBalance white_balance) {
    constexpr double percentile = 0.98, target = 0.8;
    const Eigen::Matrix3d balance = balance_matrix(image, white_balance);
    std::vector<double> values;
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
        if (const double y = luminance(balance * s0_of(image, pixel)); std::isfinite(y)) values.push_back(y);
    if (values.empty()) return 0.0;
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(percentile * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place > 0 ? std::log2(target / *place) : 0.0;
}

double roll_off(double y) {
    if (y <= shoulder) return y;
    return 1 - (1 - shoulder) * std::exp(-(y - shoulder) / (1 - shoulder));
}

Bitmap tone_map(const StokesImage& image, const ToneOptions& options) {
    PATINA_EXPECT(image.rgb.size() == image.pixel_count() * 12);
    const Eigen::Matrix3d balance = balance_matrix(image, options.white_balance);
    const double automatic_ev = options.automatic_exposure ? automatic_exposure_ev(image, options.white_balance) : 0.0;
    const double factor = std::exp2(options.exposure_ev + automatic_ev);
    Bitmap picture{"", image.width, image.height, {"R", "G", "B"}, {}};
    picture.data.reserve(image.pixel_count() * 3);
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
        Eigen::Vector3d rgb = factor * (balance * s0_of(image, pixel));
        if (!rgb.allFinite()) {
            rgb = not_a_number_color().cast<double>();
        } else if (options.tone_curve) {
            const double y = luminance(rgb), shown = roll_off(y);
            rgb = y > 0 ? into_gamut(rgb * (shown / y), shown) : Eigen::Vector3d(Eigen::Vector3d::Zero());
        }
        const Eigen::Vector3f stored = rgb.cast<float>();
        picture.data.insert(picture.data.end(), stored.data(), stored.data() + 3);
    }
    return picture;
}

}  // namespace patina::io
