#include "patina/io/image_mosaic.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/io/image_optics.h"
#include "patina/spectral/colorimetry.h"

namespace patina::io {

namespace {

constexpr double angles_deg[2][2] = {{90, 45}, {135, 0}};

// splitmix64 (Steele, Lea & Flood 2014): a stream for each pixel costs nothing to start.
class PixelRandom {
  public:
    using result_type = std::uint64_t;
    PixelRandom(std::uint64_t seed, std::uint64_t pixel) : state_(mixed(seed ^ mixed(pixel + 1))) {}
    static constexpr result_type min() { return 0; }
    static constexpr result_type max() { return ~result_type{0}; }
    result_type operator()() { return mixed(state_ += 0x9e3779b97f4a7c15u); }

  private:
    static std::uint64_t mixed(std::uint64_t x) {
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    }
    std::uint64_t state_;
};

void expect_sensible(const SensorNoise& sensor) {
    const auto refuse = [](const char* what, double value, const char* range) {
        throw Error(ErrorKind::usage, fmt::format("{} {} is out of range (keep it in {})", what, value, range));
    };
    if (!(sensor.full_well_e >= 1 && sensor.full_well_e <= 1e9)) refuse("full well", sensor.full_well_e, "1 .. 1e9");
    if (!(sensor.read_noise_e >= 0 && sensor.read_noise_e <= 1e6))
        refuse("read noise", sensor.read_noise_e, "0 .. 1e6");
    if (sensor.bits < 1 || sensor.bits > 16) refuse("bits", sensor.bits, "1 .. 16");
    const double largest = std::exp2(sensor.bits) - 1;
    if (!(sensor.black_level_dn >= 0 && sensor.black_level_dn < largest))
        refuse("black level", sensor.black_level_dn, "0 .. 2^bits - 2");
    if (!(sensor.white >= 0 && std::isfinite(sensor.white))) refuse("white", sensor.white, "0 .. inf");
}

// The pixel of `count` nearest below `at` whose index has this parity, as one of two between which `at` lies.
struct Between {
    int low, high;
    float share;  // of the higher one
};

Between between(int at, int parity, int count) {
    if (at % 2 == parity) return {at, at, 0};
    const int low = at - 1, high = at + 1;
    if (low < 0) return {high, high, 0};
    if (high >= count) return {low, low, 0};
    return {low, high, 0.5f};
}

}  // namespace

Bitmap polarization_mosaic(const StokesPlane& plane) {
    Eigen::Vector4f analyser[2][2];
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 2; ++column)
            analyser[row][column] = polarizer_mueller(angles_deg[row][column]).row(0).transpose().cast<float>();
    Bitmap frame{"", plane.width, plane.height, {"Y"}, {}};
    frame.data.reserve(plane.pixels.size());
    for (int y = 0; y < plane.height; ++y)
        for (int x = 0; x < plane.width; ++x)
            frame.data.push_back(
                analyser[y % 2][x % 2].dot(plane.pixels[static_cast<std::size_t>(y) * plane.width + x]));
    return frame;
}

double automatic_white(const Bitmap& frame) {
    constexpr double percentile = 0.995, filled = 0.8;
    std::vector<float> values;
    std::copy_if(frame.data.begin(), frame.data.end(), std::back_inserter(values),
                 [](float value) { return std::isfinite(value); });
    if (values.empty()) return 1;
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(percentile * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place > 0 ? *place / filled : 1.0;
}

Bitmap add_sensor_noise(const Bitmap& frame, const SensorNoise& sensor) {
    expect_sensible(sensor);
    const double white = sensor.white > 0 ? sensor.white : automatic_white(frame);
    const double largest_dn = std::exp2(sensor.bits) - 1;
    const double gain = (largest_dn - sensor.black_level_dn) / sensor.full_well_e;  // digital numbers an electron
    Bitmap noisy = frame;
    for (std::size_t i = 0; i < frame.data.size(); ++i) {
        if (!std::isfinite(frame.data[i])) continue;
        PixelRandom random(sensor.seed, i);
        const double mean = std::max(0.0, frame.data[i] / white) * sensor.full_well_e;
        // Above twice the well the well is full, but for one in 10^200.
        double electrons = std::min(mean, 2 * sensor.full_well_e);
        if (electrons > 0) electrons = static_cast<double>(std::poisson_distribution<std::int64_t>(electrons)(random));
        electrons = std::min(electrons, sensor.full_well_e);
        if (sensor.read_noise_e > 0) electrons += std::normal_distribution<double>(0, sensor.read_noise_e)(random);
        const double dn = std::clamp(std::nearbyint(sensor.black_level_dn + gain * electrons), 0.0, largest_dn);
        noisy.data[i] = static_cast<float>((dn - sensor.black_level_dn) / gain / sensor.full_well_e * white);
    }
    return noisy;
}

StokesImage demosaic(const Bitmap& frame) {
    if (frame.channel_count() != 1)
        throw input_error({frame.name}, "not a frame of a polarization camera",
                          fmt::format("it has {} channels, not one", frame.channel_count()));
    if (frame.width < 2 || frame.height < 2)
        throw input_error({frame.name}, "a frame has at least 2 x 2 pixels",
                          fmt::format("it has {} x {}", frame.width, frame.height));
    StokesImage image;
    image.width = image.full_width = frame.width;
    image.height = image.full_height = frame.height;
    image.rgb.assign(image.pixel_count() * 12, 0.0f);
    image.metadata["operation"] = "demosaic of a polarization camera's frame";
    const Eigen::Vector3f white = spectral::xyz_to_linear_srgb({1, 1, 1}).cast<float>();
    for (int y = 0; y < frame.height; ++y)
        for (int x = 0; x < frame.width; ++x) {
            float light[2][2];
            for (int row = 0; row < 2; ++row)
                for (int column = 0; column < 2; ++column) {
                    const Between v = between(y, row, frame.height), h = between(x, column, frame.width);
                    const auto across = [&](int line) {
                        return (1 - h.share) * *frame.pixel(h.low, line) + h.share * *frame.pixel(h.high, line);
                    };
                    light[row][column] = (1 - v.share) * across(v.low) + v.share * across(v.high);
                }
            const float stokes[3] = {0.5f * (light[0][0] + light[0][1] + light[1][0] + light[1][1]),
                                     light[1][1] - light[0][0], light[0][1] - light[1][0]};
            float* rgb = image.stokes_rgb(image.pixel_index(x, y));
            for (int k = 0; k < 3; ++k) Eigen::Map<Eigen::Vector3f>(rgb + 3 * k) = stokes[k] * white;
        }
    return image;
}

}  // namespace patina::io
