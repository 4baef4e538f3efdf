#include "patina/render/film.h"

#include <cmath>

#include <fmt/format.h>

#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

constexpr int filter_nodes = 1025;

std::vector<float> inverse_cdf(double radius, const std::function<double(double)>& filter) {
    // Integrate by the trapezoidal rule on a fine grid, then invert.
    constexpr int steps = 8192;
    std::vector<double> cdf(steps + 1, 0.0);
    const double h = 2 * radius / steps;
    for (int i = 1; i <= steps; ++i)
        cdf[i] = cdf[i - 1] + 0.5 * h * (filter(-radius + (i - 1) * h) + filter(-radius + i * h));
    std::vector<float> inverse(filter_nodes);
    int at = 0;
    for (int i = 0; i < filter_nodes; ++i) {
        const double target = cdf.back() * i / (filter_nodes - 1);
        while (at < steps - 1 && cdf[at + 1] < target) ++at;
        const double width = cdf[at + 1] - cdf[at];
        inverse[i] = static_cast<float>(-radius + h * (at + (width > 0 ? (target - cdf[at]) / width : 0.0)));
    }
    return inverse;
}

}  // namespace

PixelFilter::PixelFilter(const Properties& node) : name_(node.type) {
    expect_plugin(node);
    const auto radius_of = [&](double fallback) {
        const double radius = node.number("radius", fallback);
        if (!(radius > 0 && radius < 100)) throw input_error(node.location_of("radius"), "filter radius out of range");
        return radius;
    };
    if (node.type == "box") {
        if (const double radius = radius_of(0.5); radius != 0.5)
            inverse_cdf_ = inverse_cdf(radius, [](double) { return 1.0; });
    } else if (node.type == "tent") {
        const double radius = radius_of(1.0);
        inverse_cdf_ = inverse_cdf(radius, [=](double x) { return std::max(0.0, 1 - std::abs(x) / radius); });
    } else {
        const double sigma = node.number("stddev", 0.5);
        if (!(sigma > 0 && sigma < 100)) throw input_error(node.location_of("stddev"), "stddev out of range");
        const double radius = 4 * sigma, end = std::exp(-0.5 * 16.0);
        inverse_cdf_ = inverse_cdf(
            radius, [=](double x) { return std::max(0.0, std::exp(-0.5 * x * x / (sigma * sigma)) - end); });
    }
    expect_known_properties(node);
}

float PixelFilter::sample(float u) const {
    if (inverse_cdf_.empty()) return u - 0.5f;
    const float x = u * (filter_nodes - 1);
    const int i = std::min(static_cast<int>(x), filter_nodes - 2);
    return inverse_cdf_[i] + (x - i) * (inverse_cdf_[i + 1] - inverse_cdf_[i]);
}

float PixelFilter::density(float offset) const {
    if (inverse_cdf_.empty()) return std::abs(offset) <= 0.5f ? 1.0f : 0.0f;
    // Between two nodes sample() is uniform.
    const auto upper = std::upper_bound(inverse_cdf_.begin(), inverse_cdf_.end(), offset);
    if (upper == inverse_cdf_.begin() || upper == inverse_cdf_.end()) return 0;
    return 1 / ((filter_nodes - 1) * (*upper - *(upper - 1)));
}

std::vector<double> FilmSettings::default_bins() {
    std::vector<double> edges;
    for (int i = 0; i <= 16; ++i) edges.push_back(380 + 25.0 * i);
    return edges;
}

FilmSettings build_film(const Properties& node) {
    expect_plugin(node);
    FilmSettings film;
    const auto positive = [&](const char* name, std::int64_t fallback) {
        const std::int64_t value = node.integer(name, fallback);
        if (value < 1 || value > 65536)
            throw input_error(node.location_of(name), fmt::format("{} out of range", name),
                              fmt::format("it is {}", value), "keep it between 1 and 65536");
        return static_cast<int>(value);
    };
    film.width = positive("width", 768);
    film.height = positive("height", 576);
    const auto offset = [&](const char* name) {
        return static_cast<int>(std::clamp<std::int64_t>(node.integer(name, 0), -1, 65536));
    };
    film.crop_x = offset("crop_offset_x");
    film.crop_y = offset("crop_offset_y");
    film.crop_width = positive("crop_width", film.width);
    film.crop_height = positive("crop_height", film.height);
    if (film.crop_x < 0 || film.crop_y < 0 || film.crop_x + film.crop_width > film.width ||
        film.crop_y + film.crop_height > film.height)
        throw input_error(node.where, "the crop window leaves the film",
                          fmt::format("film {} x {}", film.width, film.height));
    if (const auto filter = node.only_child("rfilter")) film.filter = PixelFilter(*filter);
    for (const char* name : {"file_format", "pixel_format", "component_format"}) node.string(name, "");
    node.boolean("banner", false);
    node.boolean("sample_border", false);
    film.bin_edges_nm = FilmSettings::default_bins();
    expect_known_properties(node);
    return film;
}

Film::Film(const FilmSettings& settings, const ColourMatching& matching, bool with_variance)
    : settings_(settings), bins_(static_cast<int>(settings.bin_edges_nm.size()) - 1) {
    PATINA_EXPECT(bins_ >= 1);
    stride_ = bins_ + 5;
    sums_.assign(pixel_count() * stride_, splat(0));
    if (with_variance) batches_.assign(pixel_count() * most_batches, splat(0));
    const std::vector<double>& edges = settings_.bin_edges_nm;
    for (int b = 0; b < bins_; ++b)
        bin_weight_.push_back(
            static_cast<float>(wavelength_range_nm / wavelengths_per_path / (edges[b + 1] - edges[b])));
    for (int node = 0; node < spectrum_nodes; ++node) {
        const double nm = wavelength_min_nm + node;
        const auto upper = std::upper_bound(edges.begin(), edges.end(), nm);
        nanometres_.push_back({0.25f * matching.xyz(node), static_cast<int>(upper - edges.begin()) - 1,
                               upper == edges.end() || *upper > nm + 1 ? INFINITY : static_cast<float>(*upper)});
    }
}

void Film::end_batch(std::size_t pixel, [[maybe_unused]] int samples) {
    Float4* colour = &sums_[pixel * stride_] + bins_;
    Float4* ends = &batches_[pixel * most_batches];
    // Join the batches two by two when this one is the first of twice the size.
    int batches = static_cast<int>(colour[4][2]);
    if (batches == most_batches) {
        for (batches = 0; batches < most_batches / 2; ++batches) ends[batches] = ends[2 * batches + 1];
    }
    PATINA_ASSERT(samples == (batches + 1) * batch_size(samples));
    ends[batches] = Float4{colour[0][1], colour[1][1], colour[2][1], colour[3][1]};
    colour[4][2] = static_cast<float>(batches + 1);
    colour[4][3] = colour[4][0];
}

std::array<double, 4> Film::variances_of_means(std::size_t pixel) const {
    const Float4* colour = &sums_[pixel * stride_] + bins_;
    const int batches = static_cast<int>(colour[4][2]);
    if (batches < 2) return {INFINITY, INFINITY, INFINITY, INFINITY};
    const Float4* ends = &batches_[pixel * most_batches];
    const double samples = colour[4][0], size = colour[4][3] / batches;
    std::array<double, 4> variances{};
    for (int k = 0; k < 4; ++k) {
        const double mean = ends[batches - 1][k] / (batches * size);
        double before = 0;
        for (int b = 0; b < batches; ++b) {
            const double difference = (ends[b][k] - before) / size - mean;
            variances[k] += difference * difference / (batches - 1) * size / samples;
            before = ends[b][k];
        }
    }
    return variances;
}

double Film::relative_noise() const {
    double variance = 0, luminance = 0;
    for (std::size_t pixel = 0; pixel < pixel_count(); ++pixel) {
        const Float4* colour = &sums_[pixel * stride_] + bins_;
        luminance += static_cast<double>(colour[0][1]) / colour[4][0];
        variance += variances_of_means(pixel)[0];
    }
    const double pixels = static_cast<double>(pixel_count());
    return luminance > 0 ? std::sqrt(variance / pixels) / (luminance / pixels) : 0.0;
}

StokesImage Film::develop() const {
    StokesImage image;
    image.width = settings_.crop_width, image.height = settings_.crop_height;
    image.crop_x = settings_.crop_x, image.crop_y = settings_.crop_y;
    image.full_width = settings_.width, image.full_height = settings_.height;
    image.bin_edges_nm = settings_.bin_edges_nm;
    const std::size_t pixels = pixel_count();
    image.spectral.resize(pixels * bins_ * 4);
    image.rgb.resize(pixels * 12);
    image.alpha.resize(pixels);
    image.variance.resize(pixels * 4);
    bool spread_known = false;
    image.sample_count.resize(pixels);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const Float4* sums = &sums_[pixel * stride_];
        const Float4* colour = sums + bins_;
        const float n = colour[4][0];
        if (n == 0) continue;
        for (int b = 0; b < bins_; ++b)
            for (int k = 0; k < 4; ++k) image.stokes(pixel, b)[k] = sums[b][k] / n;
        for (int k = 0; k < 4; ++k) {
            const Vec3 xyz = Vec3(colour[k][0], colour[k][1], colour[k][2]) / n;
            Eigen::Map<Vec3>(image.stokes_rgb(pixel) + 3 * k) = xyz_to_srgb(xyz);
        }
        image.alpha[pixel] = colour[4][1] / n;
        image.sample_count[pixel] = static_cast<std::uint32_t>(n);
        if (const std::array<double, 4> variances = variances_of_means(pixel); std::isfinite(variances[0])) {
            for (int k = 0; k < 4; ++k) image.variance[pixel * 4 + k] = static_cast<float>(variances[k]);
            spread_known = true;
        }
    }
    if (!spread_known) image.variance.clear();
    return image;
}

}  // namespace patina::render
