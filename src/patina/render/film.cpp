#include "patina/render/film.h"

#include <cmath>

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

constexpr int filter_nodes = 1025;

constexpr int filter_steps = 8192;

// Of the area under `filter` over -radius .. radius, by the trapezoidal rule on a fine grid; `area` is the whole of it.
std::vector<float> inverse_cdf(double radius, const std::function<double(double)>& filter, double& area) {
    std::vector<double> cdf(filter_steps + 1, 0.0);
    const double h = 2 * radius / filter_steps;
    for (int i = 1; i <= filter_steps; ++i)
        cdf[i] = cdf[i - 1] + 0.5 * h * (filter(-radius + (i - 1) * h) + filter(-radius + i * h));
    area = cdf.back();
    std::vector<float> inverse(filter_nodes);
    int at = 0;
    for (int i = 0; i < filter_nodes; ++i) {
        const double target = cdf.back() * i / (filter_nodes - 1);
        while (at < filter_steps - 1 && cdf[at + 1] < target) ++at;
        const double width = cdf[at + 1] - cdf[at];
        inverse[i] = static_cast<float>(-radius + h * (at + (width > 0 ? (target - cdf[at]) / width : 0.0)));
    }
    return inverse;
}

// Mitchell & Netravali (1988), Reconstruction filters in computer graphics, eq. 8.
double cubic(double x, double b, double c) {
    x = std::abs(x);
    if (x >= 2) return 0;
    if (x < 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + 6 - 2 * b) / 6;
    return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + 8 * b + 24 * c) / 6;
}

double sinc(double x) {
    return std::abs(x) < 1e-6 ? 1.0 : std::sin(pi * x) / (pi * x);
}

double number_within(const Properties& node, const char* name, double fallback, double low, double high) {
    const double value = node.number(name, fallback);
    if (value >= low && value <= high) return value;
    throw input_error(node.location_of(name), fmt::format("{} of the filter is out of range", name),
                      fmt::format("it is {}", value), fmt::format("keep it between {} and {}", low, high));
}

}  // namespace

PixelFilter::PixelFilter(const Properties& node) : name_(node.type) {
    expect_plugin(node);
    const auto radius_of = [&](double fallback) { return number_within(node, "radius", fallback, 1e-3, 100); };
    if (node.type == "box") {
        if (const double radius = radius_of(0.5); radius != 0.5) tabulate(radius, [](double) { return 1.0; });
    } else if (node.type == "tent") {
        const double radius = radius_of(1.0);
        tabulate(radius, [=](double x) { return std::max(0.0, 1 - std::abs(x) / radius); });
    } else if (node.type == "gaussian") {
        const double sigma = number_within(node, "stddev", 0.5, 1e-3, 100), end = std::exp(-0.5 * 16.0);
        tabulate(4 * sigma, [=](double x) { return std::max(0.0, std::exp(-0.5 * x * x / (sigma * sigma)) - end); });
    } else if (node.type == "lanczos") {
        const auto lobes = static_cast<double>(node.integer("lobes", 3));
        number_within(node, "lobes", 3, 1, 16);
        tabulate(lobes, [=](double x) { return std::abs(x) < lobes ? sinc(x) * sinc(x / lobes) : 0.0; });
    } else {
        // Beyond these the lobes take the most of the filter.
        const bool mitchell = node.type == "mitchell";
        const double b = mitchell ? number_within(node, "A", 1.0 / 3, 0, 1) : 0.0;
        const double c = mitchell ? number_within(node, "B", 1.0 / 3, 0, 1) : 0.5;
        tabulate(2, [=](double x) { return cubic(x, b, c); });
    }
    expect_known_properties(node);
}

void PixelFilter::tabulate(double radius, std::function<double(double)> filter) {
    double positive = 0, negative = 0;
    positive_ = inverse_cdf(
        radius, [&](double x) { return std::max(0.0, filter(x)); }, positive);
    reach_ = positive_.back();
    InverseCdf lobes = inverse_cdf(
        radius, [&](double x) { return std::max(0.0, -filter(x)); }, negative);
    if (!(negative > 1e-9 * positive)) return;
    negative_ = std::move(lobes);
    reach_ = static_cast<float>(radius);
    share_ = static_cast<float>(negative / (positive + negative));
    mean_weight_ = static_cast<float>(std::pow((positive - negative) / (positive + negative), 2));
    lobed_ = [filter = std::move(filter), scale = 1 / (positive - negative)](double x) { return scale * filter(x); };
}

float PixelFilter::drawn(const InverseCdf& table, float u) {
    if (table.empty()) return u - 0.5f;
    const float x = u * (filter_nodes - 1);
    const int i = std::min(static_cast<int>(x), filter_nodes - 2);
    return table[i] + (x - i) * (table[i + 1] - table[i]);
}

// The first number alone decides whether the place lies in a lobe along x, along y, or has weight 1: it is stratified
// over the samples of a pixel, so that the weights add up to nearly the same sum in all pixels.
PixelFilter::Place PixelFilter::sample_lobes(const Vec2& u) const {
    const float one = share_ * (1 - share_), both = share_ * share_;
    float first = 0, width = one;
    bool lobe_x = true, lobe_y = false;
    if (u.x() >= one) first = one, lobe_x = false, lobe_y = true;
    if (u.x() >= 2 * one) first = 2 * one, width = both, lobe_x = lobe_y = true;
    if (u.x() >= 2 * one + both) first = 2 * one + both, width = 1 - first, lobe_x = lobe_y = false;
    const float rest = std::clamp((u.x() - first) / width, 0.0f, 0x1.fffffep-1f);
    return {{drawn(lobe_x ? negative_ : positive_, rest), drawn(lobe_y ? negative_ : positive_, u.y())},
            lobe_x == lobe_y ? 1.0f : -1.0f};
}

float PixelFilter::value(float offset) const {
    if (lobed_) return static_cast<float>(lobed_(offset));
    if (positive_.empty()) return std::abs(offset) <= 0.5f ? 1.0f : 0.0f;
    // Between two nodes sample() is uniform.
    const auto upper = std::upper_bound(positive_.begin(), positive_.end(), offset);
    if (upper == positive_.begin() || upper == positive_.end()) return 0;
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
    node.boolean("compensate", false);
    for (const Properties::Entry& entry : node.entries)
        if (std::holds_alternative<SpectrumSpec>(entry.value))
            throw input_error(entry.where, fmt::format("the film has no sensitivity \"{}\"", entry.name),
                              "every picture has 16 spectral bands of 25 nm", "leave it out");
    node.boolean("sample_border", false);
    film.bin_edges_nm = FilmSettings::default_bins();
    expect_known_properties(node);
    return film;
}

Film::Film(const FilmSettings& settings, const ColourMatching& matching, bool with_variance, bool weighted)
    : settings_(settings), bins_(static_cast<int>(settings.bin_edges_nm.size()) - 1) {
    PATINA_EXPECT(bins_ >= 1);
    stride_ = bins_ + 5;
    sums_.assign(pixel_count() * stride_, splat(0));
    if (with_variance) batches_.assign(pixel_count() * most_batches, splat(0));
    if (weighted) weights_.assign(pixel_count() * weight_stride, 0.0f);
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
        for (batches = 0; batches < most_batches / 2; ++batches) {
            ends[batches] = ends[2 * batches + 1];
            if (weights_.empty()) continue;
            float* weights = &weights_[pixel * weight_stride + 1];
            weights[batches] = weights[2 * batches + 1];
        }
    }
    PATINA_ASSERT(samples == (batches + 1) * batch_size(samples));
    ends[batches] = Float4{colour[0][1], colour[1][1], colour[2][1], colour[3][1]};
    if (!weights_.empty()) weights_[pixel * weight_stride + 1 + batches] = weights_[pixel * weight_stride];
    colour[4][2] = static_cast<float>(batches + 1);
    colour[4][3] = colour[4][0];
}

std::array<double, 4> Film::variances_of_means(std::size_t pixel) const {
    const Float4* colour = &sums_[pixel * stride_] + bins_;
    const int batches = static_cast<int>(colour[4][2]);
    if (batches < 2) return {INFINITY, INFINITY, INFINITY, INFINITY};
    const Float4* ends = &batches_[pixel * most_batches];
    const double size = colour[4][3] / batches;
    const double weight = weight_at_end(pixel, batches - 1, size), whole = divisor(pixel);
    std::array<double, 4> variances{};
    if (!(weight > 0)) return {INFINITY, INFINITY, INFINITY, INFINITY};
    // Of a ratio of means, which without lobes has a denominator that does not vary (Cochran 1977, section 6.4).
    for (int k = 0; k < 4; ++k) {
        const double mean = ends[batches - 1][k] / weight;
        double before = 0, weight_before = 0;
        for (int b = 0; b < batches; ++b) {
            const double now = weight_at_end(pixel, b, size);
            const double difference = ends[b][k] - before - mean * (now - weight_before);
            variances[k] += difference * difference * batches / (batches - 1) / (weight * whole);
            before = ends[b][k], weight_before = now;
        }
    }
    return variances;
}

// Few samples may lie in lobes by more than half: then the sum of weights tells nothing, and half of what it is on
// average stands for it.
float Film::divisor(std::size_t pixel) const {
    const float samples = sums_[pixel * stride_ + bins_ + 4][0];
    if (weights_.empty()) return samples;
    return std::max(weights_[pixel * weight_stride], 0.5f * settings_.filter.mean_weight() * samples);
}

double Film::weight_at_end(std::size_t pixel, int batch, double batch_samples) const {
    return weights_.empty() ? (batch + 1) * batch_samples : weights_[pixel * weight_stride + 1 + batch];
}

double Film::relative_noise() const {
    double variance = 0, luminance = 0;
    for (std::size_t pixel = 0; pixel < pixel_count(); ++pixel) {
        const Float4* colour = &sums_[pixel * stride_] + bins_;
        luminance += static_cast<double>(colour[0][1]) / divisor(pixel);
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
        const float samples = colour[4][0], n = divisor(pixel);
        if (samples == 0) continue;
        for (int b = 0; b < bins_; ++b)
            for (int k = 0; k < 4; ++k) image.stokes(pixel, b)[k] = sums[b][k] / n;
        for (int k = 0; k < 4; ++k) {
            const Vec3 xyz = Vec3(colour[k][0], colour[k][1], colour[k][2]) / n;
            Eigen::Map<Vec3>(image.stokes_rgb(pixel) + 3 * k) = xyz_to_srgb(xyz);
        }
        image.alpha[pixel] = colour[4][1] / samples;
        image.sample_count[pixel] = static_cast<std::uint32_t>(samples);
        if (const std::array<double, 4> variances = variances_of_means(pixel); std::isfinite(variances[0])) {
            for (int k = 0; k < 4; ++k) image.variance[pixel * 4 + k] = static_cast<float>(variances[k]);
            spread_known = true;
        }
    }
    if (!spread_known) image.variance.clear();
    return image;
}

}  // namespace patina::render
