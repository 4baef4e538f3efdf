#include "patina/io/image_compare.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/io/image_stokes.h"

namespace patina::io {

namespace {

void expect_same_size(const StokesImage& a, const StokesImage& b) {
    if (a.width == b.width && a.height == b.height) return;
    throw Error(ErrorKind::input, fmt::format("the images have different sizes ({} x {} and {} x {} pixels)", a.width,
                                              a.height, b.width, b.height));
}

bool same_bins(const StokesImage& a, const StokesImage& b) {
    if (a.bin_count() == 0 || a.bin_count() != b.bin_count()) return false;
    // Edges are stored as 32-bit floats, which resolve 6e-5 nm in the visible.
    for (std::size_t i = 0; i < a.bin_edges_nm.size(); ++i)
        if (std::abs(a.bin_edges_nm[i] - b.bin_edges_nm[i]) > 1e-3) return false;
    return true;
}

// Values of all pixels with `bands` values of a component a pixel; component and band of value i are found by the
// caller.
template <class ComponentOf>
ImageDifference compare_values(const StokesImage& a, std::span<const float> left, std::span<const float> right,
                               const ComponentOf& component_of) {
    ImageDifference difference;
    std::array<std::size_t, 4> counts{};
    const std::size_t per_pixel = left.size() / std::max<std::size_t>(a.pixel_count(), 1);
    for (std::size_t i = 0; i < left.size(); ++i) {
        const double d = double(left[i]) - double(right[i]);
        if (!std::isfinite(d)) {
            ++difference.not_finite;
            continue;
        }
        ComponentDifference& component = difference.stokes[component_of(i)];
        ++counts[component_of(i)];
        component.root_mean_square += d * d;
        component.mean += d;
        component.mean_absolute += std::abs(d);
        if (std::abs(d) > component.largest) {
            component.largest = std::abs(d);
            component.largest_x = static_cast<int>(i / per_pixel % a.width);
            component.largest_y = static_cast<int>(i / per_pixel / a.width);
        }
    }
    for (int k = 0; k < 4; ++k) {
        const double count = std::max<double>(static_cast<double>(counts[k]), 1);
        difference.stokes[k].root_mean_square = std::sqrt(difference.stokes[k].root_mean_square / count);
        difference.stokes[k].mean /= count;
        difference.stokes[k].mean_absolute /= count;
    }
    return difference;
}

}  // namespace

ImageDifference compare_images(const StokesImage& a, const StokesImage& b) {
    expect_same_size(a, b);
    if (same_bins(a, b)) {
        ImageDifference difference = compare_values(a, a.spectral, b.spectral, [](std::size_t i) { return i % 4; });
        difference.bands = "spectral";
        return difference;
    }
    ImageDifference difference = compare_values(a, a.rgb, b.rgb, [](std::size_t i) { return i / 3 % 4; });
    difference.bands = "rgb";
    return difference;
}

StokesImage subtract_images(const StokesImage& a, const StokesImage& b) {
    expect_same_size(a, b);
    StokesImage difference = a;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) difference.rgb[i] -= b.rgb[i];
    if (same_bins(a, b)) {
        for (std::size_t i = 0; i < a.spectral.size(); ++i) difference.spectral[i] -= b.spectral[i];
    } else {
        difference.bin_edges_nm.clear();
        difference.spectral.clear();
    }
    difference.variance.clear();
    difference.sample_count.clear();
    difference.metadata = {{"operation", "difference of two images"}};
    return difference;
}

namespace {

// value(pixel) over S0 of the reference, where there is light.
template <class Value>
std::vector<float> shares_of_intensity(const StokesPlane& reference, const Value& value) {
    double mean = 0;
    for (const Eigen::Vector4f& stokes : reference.pixels)
        if (std::isfinite(stokes[0])) mean += std::abs(stokes[0]) / static_cast<double>(reference.pixels.size());
    std::vector<float> shares;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        const float intensity = reference.pixels[i][0];
        shares.push_back(intensity < 1e-4 * mean || intensity == 0 ? 0.0f : value(i) / intensity);
    }
    return shares;
}

}  // namespace

std::vector<float> relative_errors(const StokesImage& a, const StokesImage& b, int component) {
    expect_same_size(a, b);
    const StokesPlane first = select_band(a), second = select_band(b);
    return shares_of_intensity(
        second, [&](std::size_t i) { return std::abs(first.pixels[i][component] - second.pixels[i][component]); });
}

std::vector<float> relative_noise(const StokesImage& image, int component) {
    if (image.variance.empty())
        throw Error(ErrorKind::input,
                    "the picture does not state its noise (no channels variance.S0 ... variance.S3; patina render "
                    "writes them from two samples per pixel on)");
    return shares_of_intensity(select_band(image),
                               [&](std::size_t i) { return std::sqrt(image.variance[4 * i + component]); });
}

ImageSummary summarize_image(const StokesImage& image) {
    const StokesPlane plane = select_band(image);
    ImageSummary summary;
    std::size_t count = 0;
    double polarized = 0;
    for (const Eigen::Vector4f& stokes : plane.pixels) {
        if (!stokes.allFinite()) {
            ++summary.not_finite;
            continue;
        }
        for (int k = 0; k < 4; ++k) {
            const double value = stokes[k];
            summary.smallest[k] = count == 0 ? value : std::min(summary.smallest[k], value);
            summary.largest[k] = count == 0 ? value : std::max(summary.largest[k], value);
            summary.mean[k] += value;
        }
        polarized += stokes.segment<2>(1).norm();
        summary.over_polarized += dop(stokes) > 1.001f;
        ++count;
    }
    if (count == 0) return summary;
    if (summary.mean[0] > 0) summary.mean_dolp = polarized / summary.mean[0];
    for (double& mean : summary.mean) mean /= static_cast<double>(count);
    for (const Eigen::Vector4f& stokes : plane.pixels)
        if (stokes.allFinite() && stokes[0] > 1e-3 * summary.mean[0])
            summary.largest_dolp = std::max<double>(summary.largest_dolp, dolp(stokes));
    return summary;
}

}  // namespace patina::io
