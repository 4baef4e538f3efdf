// The polarization camera: Malus' law in its mosaic, the photon transfer curve of its sensor, and the way back.

#include "patina/io/image_mosaic.h"

#include <cmath>

#include <gtest/gtest.h>

#include "patina/core/error.h"
#include "patina/io/image_optics.h"

namespace patina::io {
namespace {

Bitmap uniform_frame(float value, int side = 200) {
    return {"", side, side, {"Y"}, std::vector<float>(static_cast<std::size_t>(side) * side, value)};
}

struct Moments {
    double mean = 0, variance = 0;
};

Moments moments(const Bitmap& frame) {
    Moments m;
    const double n = static_cast<double>(frame.data.size());
    for (float v : frame.data) m.mean += v / n;
    for (float v : frame.data) m.variance += (v - m.mean) * (v - m.mean) / (n - 1);
    return m;
}

// EMVA 1288, eq. 10: in digital numbers the variance is gain^2 (mean electrons + read noise^2) + 1/12. In the unit of
// the light, white = full well. Means are held to 5 standard errors of 40 000 pixels, variances to 5 of theirs, which
// is variance sqrt(2/40000).
TEST(SensorNoise, HasThePhotonTransferCurve) {
    for (const double read_noise : {0.0, 3.0})
        for (const int bits : {6, 12})
            for (const double light : {0.02, 0.3, 0.7}) {
                SensorNoise sensor{
                    .full_well_e = 5000, .read_noise_e = read_noise, .bits = bits, .white = 2.0, .seed = 7};
                sensor.black_level_dn = bits == 6 ? 4 : 100;
                const Moments m = moments(add_sensor_noise(uniform_frame(static_cast<float>(2 * light)), sensor));
                const double step = sensor.full_well_e / (std::exp2(bits) - 1 - sensor.black_level_dn);  // electrons
                const double electrons = light * sensor.full_well_e;
                const double expected = electrons + read_noise * read_noise + step * step / 12;
                const double unit = 2.0 / sensor.full_well_e;
                // Rounding neither biases nor correlates where the noise before it covers half a step (Widrow & Kollar
                // 2008).
                if (std::sqrt(electrons) < 0.5 * step) continue;
                EXPECT_NEAR(m.mean / unit, electrons, 5 * std::sqrt(expected / 40000) + 0.01 * step)
                    << bits << " " << light;
                EXPECT_NEAR(m.variance / unit / unit, expected,
                            5 * expected * std::sqrt(2.0 / 40000) + 0.01 * step * step)
                    << bits << " " << light;
            }
}

TEST(SensorNoise, SaturatesAtWhiteAndIsTheSeeds) {
    const SensorNoise sensor{.white = 1, .seed = 3};
    for (float v : add_sensor_noise(uniform_frame(3, 20), sensor).data)
        EXPECT_NEAR(v, 1, 0.002);  // read noise below it
    SensorNoise other = sensor;
    other.seed = 4;
    const Bitmap frame = uniform_frame(0.5f, 20);
    EXPECT_EQ(add_sensor_noise(frame, sensor).data, add_sensor_noise(frame, sensor).data);
    EXPECT_NE(add_sensor_noise(frame, sensor).data, add_sensor_noise(frame, other).data);
    // Neighbours are independent: the covariance of 39 999 pairs is within 5 standard errors of zero.
    const Bitmap noisy = add_sensor_noise(uniform_frame(0.5f), sensor);
    const Moments m = moments(noisy);
    double covariance = 0;
    for (std::size_t i = 1; i < noisy.data.size(); ++i)
        covariance += (noisy.data[i] - m.mean) * (noisy.data[i - 1] - m.mean) / 39999;
    EXPECT_NEAR(covariance / m.variance, 0, 5 / std::sqrt(39999.0));
    other.bits = 17;
    EXPECT_THROW(add_sensor_noise(frame, other), Error);
}

StokesPlane ramp(int width, int height) {
    StokesPlane plane{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            plane.pixels.push_back({1 + 0.1f * x, 0.2f + 0.02f * y, -0.3f + 0.01f * x, 0.1f});
    return plane;
}

// Linear interpolation is exact for light that changes linearly, but for the rows and columns at the edge.
TEST(Demosaic, GivesBackWhatChangesLinearly) {
    const StokesPlane plane = ramp(9, 8);
    const StokesPlane back = select_band(demosaic(polarization_mosaic(plane)));
    for (int y = 1; y < 7; ++y)
        for (int x = 1; x < 8; ++x) {
            const Eigen::Vector4f expected = plane.pixels[y * 9 + x], found = back.pixels[y * 9 + x];
            // The weights of the luminance have four digits.
            EXPECT_LT((found.head<3>() - expected.head<3>()).norm(), 3e-5f) << x << " " << y;
            EXPECT_EQ(found[3], 0);
        }
    EXPECT_THROW(demosaic(uniform_frame(1, 1)), Error);
}

// Noise makes unpolarized light look polarized: S1 and S2 have each the variance of two pixels, which without
// interpolation gives a mean DoLP of sqrt(pi/2) sqrt(2 var)/S0 (Rayleigh's distribution).
TEST(Demosaic, NoiseLooksLikePolarization) {
    const SensorNoise sensor{.full_well_e = 10000, .read_noise_e = 0, .bits = 16, .white = 1, .seed = 11};
    const double electrons = 2500;  // I = 0.25 in each pixel, S0 = 0.5
    const Bitmap noisy = add_sensor_noise(uniform_frame(0.25f), sensor);
    double mean = 0;
    int count = 0;
    for (int y = 0; y < 200; y += 2)
        for (int x = 0; x < 200; x += 2, ++count) {
            const float s1 = *noisy.pixel(x + 1, y + 1) - *noisy.pixel(x, y),
                        s2 = *noisy.pixel(x + 1, y) - *noisy.pixel(x, y + 1);
            mean += std::hypot(s1, s2) / 0.5;
        }
    mean /= count;
    const double expected = std::sqrt(std::acos(-1.0) / 2) * std::sqrt(2 * electrons) / (2 * electrons);
    // 10 000 blocks: 5 standard errors of 0.52 of the mean each, and the spread of S0, which is left out.
    EXPECT_NEAR(mean / expected, 1, 5 * 0.52 / 100 + 2e-3);
    const StokesPlane plane = select_band(demosaic(noisy));
    EXPECT_LT(dolp(plane.pixels[100 * 200 + 100]), 10 * expected);
}

}  // namespace
}  // namespace patina::io
