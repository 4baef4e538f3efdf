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

// Differences of values [pixel][...] sorted into `kinds` by place, and how many are not numbers.
template <class KindOf>
std::vector<ComponentDifference> compare_values(const StokesImage& a, std::span<const float> left,
                                                std::span<const float> right, int kinds, const KindOf& kind_of,
                                                std::size_t& not_finite) {
    std::vector<ComponentDifference> differences(kinds);
    std::vector<std::size_t> counts(kinds);
    const std::size_t per_pixel = left.size() / std::max<std::size_t>(a.pixel_count(), 1);
    not_finite = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
        const double d = double(left[i]) - double(right[i]);
        if (!std::isfinite(d)) {
            ++not_finite;
            continue;
        }
        ComponentDifference& of_kind = differences[kind_of(i)];
        ++counts[kind_of(i)];
        of_kind.root_mean_square += d * d;
        of_kind.mean += d;
        of_kind.mean_absolute += std::abs(d);
        if (std::abs(d) > of_kind.largest) {
            of_kind.largest = std::abs(d);
            of_kind.largest_x = static_cast<int>(i / per_pixel % a.width);
            of_kind.largest_y = static_cast<int>(i / per_pixel / a.width);
        }
    }
    for (int k = 0; k < kinds; ++k) {
        const double count = std::max<double>(static_cast<double>(counts[k]), 1);
        differences[k].root_mean_square = std::sqrt(differences[k].root_mean_square / count);
        differences[k].mean /= count;
        differences[k].mean_absolute /= count;
    }
    return differences;
}

}  // namespace

ImageDifference compare_images(const StokesImage& a, const StokesImage& b) {
    expect_same_size(a, b);
    ImageDifference difference;
    std::size_t rgb_not_finite = 0;
    const auto channels = compare_values(
        a, a.rgb, b.rgb, 12, [](std::size_t i) { return static_cast<int>(i % 12); }, rgb_not_finite);
    for (int i = 0; i < 12; ++i) difference.rgb[i / 3][i % 3] = channels[i];

    const bool spectral = same_bins(a, b);
    difference.bands = spectral ? "spectral" : "rgb";
    const auto component_of = [&](std::size_t i) { return static_cast<int>(spectral ? i % 4 : i / 3 % 4); };
    const auto components = compare_values(a, spectral ? a.spectral : a.rgb, spectral ? b.spectral : b.rgb, 4,
                                           component_of, difference.not_finite);
    std::copy(components.begin(), components.end(), difference.stokes.begin());
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
