#pragma once
// For tests of integrators: scenes that need all of light transport, and a test whether two pictures have equal means.
//
// Each picture is rendered several times with independent seeds; blocks of it are compared by Welch's t with its
// degrees of freedom, and the smallest p of a pair of pictures is judged by Bonferroni's rule at 1e-5 a pair: with some
// fifty pairs in all tests together a false alarm has a chance below 5e-4. The seeds are fixed, so what passes once,
// passes.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "patina/render/test_support.h"

namespace patina::render::test {

using Eigen::Vector3d;

inline constexpr double false_alarm_rate = 1e-5;
inline constexpr int replicates = 8, size = 8, block = 4;

// Two-sided tail of Student's distribution, by Simpson's rule on t = sqrt(n) tan(a): the density is cos^(n-1).
inline double student_tail(double t, double n) {
    const double edge = std::atan(std::abs(t) / std::sqrt(n));
    const auto integral = [&](double a, double b) {
        constexpr int steps = 2000;
        double sum = 0;
        for (int i = 0; i <= steps; ++i)
            sum += (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2) * std::pow(std::cos(a + (b - a) * i / steps), n - 1);
        return sum * (b - a) / steps;
    };
    const double quarter = std::acos(0.0) - 1e-12;
    return integral(edge, quarter) / integral(0, quarter);
}

// [quantity][replicate]: mean over blocks of 4 x 4 pixels and all wavelengths, of each Stokes component.
using Measurements = std::vector<std::vector<double>>;

inline void append(const StokesImage& image, Measurements& all) {
    const int across = size / block;
    all.resize(across * across * 4);
    std::vector<double> sums(all.size(), 0.0);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            for (int b = 0; b < image.bin_count(); ++b)
                for (int k = 0; k < 4; ++k)
                    sums[((y / block) * across + x / block) * 4 + k] +=
                        image.stokes(image.pixel_index(x, y), b)[k] / (image.bin_count() * block * block);
    for (std::size_t i = 0; i < sums.size(); ++i) all[i].push_back(sums[i]);
}

inline Measurements measure(const Scene& scene, const std::string& integrator, int samples,
                            const std::string& part = "", int first_seed = 0) {
    Measurements all;
    for (int r = 0; r < replicates; ++r) {
        RenderOptions options;
        options.integrator = integrator;
        options.samples_per_pixel = samples;
        options.seed = 1000 + first_seed + r;
        if (!part.empty()) options.light_paths = {{"part", part}};
        const Pictures pictures = render_parts(scene, options);
        append(part.empty() ? pictures.whole : pictures.parts[0].second, all);
    }
    return all;
}

// The smallest p value of all comparisons times their number; where both are exact (nothing varies) they must be equal.
inline double corrected_p(const Measurements& a, const Measurements& b) {
    double smallest = 1;
    for (std::size_t i = 0; i < a.size(); ++i) {
        double mean[2] = {0, 0}, variance[2] = {0, 0};
        const std::vector<double>* values[2] = {&a[i], &b[i]};
        for (int j = 0; j < 2; ++j) {
            for (double v : *values[j]) mean[j] += v / replicates;
            for (double v : *values[j])
                variance[j] += (v - mean[j]) * (v - mean[j]) / (replicates * (replicates - 1.0));
        }
        const double spread = variance[0] + variance[1], difference = mean[0] - mean[1];
        // Single precision leaves 1e-6 of the intensity.
        if (std::abs(difference) < 1e-6 * (1e-3 + std::abs(a[i / 4 * 4][0]))) continue;
        if (spread == 0) return 0;
        const double freedom =
            spread * spread / ((variance[0] * variance[0] + variance[1] * variance[1]) / (replicates - 1.0));
        const double p = student_tail(difference / std::sqrt(spread), freedom);
        smallest = std::min(smallest, p * static_cast<double>(a.size()));
    }
    return smallest;
}

inline void expect_agreement(const Measurements& a, const Measurements& b, const std::string& what) {
    EXPECT_GT(corrected_p(a, b), false_alarm_rate) << what;
}

// How well the mean picture is known: the largest standard error of a block's intensity over the mean intensity. A test
// that knows nothing cannot fail.
inline double relative_error(const Measurements& a) {
    double largest = 0, total = 0;
    for (std::size_t i = 0; i < a.size(); i += 4) {
        double mean = 0, variance = 0;
        for (double v : a[i]) mean += v / replicates;
        for (double v : a[i]) variance += (v - mean) * (v - mean) / (replicates * (replicates - 1.0));
        largest = std::max(largest, std::sqrt(variance));
        total += mean / (a.size() / 4.0);
    }
    return largest / total;
}

// By how many standard errors a Stokes component differs from zero, in the block where it does most.
inline double significance(const Measurements& a, int component) {
    double largest = 0;
    for (std::size_t i = component; i < a.size(); i += 4) {
        double mean = 0, variance = 0;
        for (double v : a[i]) mean += v / replicates;
        for (double v : a[i]) variance += (v - mean) * (v - mean) / (replicates * (replicates - 1.0));
        if (variance > 0) largest = std::max(largest, std::abs(mean) / std::sqrt(variance));
    }
    return largest;
}

inline Node lamp(double radiance, double half_width = 0.5) {
    return node(
        "shape", "rectangle",
        {{"to_world", Eigen::Matrix4d(translate({0, 0, 2}) * rotate_x(180) * scale(half_width, half_width, 1))}},
        {node("emitter", "area", {uniform("radiance", radiance)})});
}
inline Node floor(double reflectance) {
    return node("shape", "rectangle", {{"to_world", scale(2, 2, 1)}},
                {node("bsdf", "diffuse", {uniform("reflectance", reflectance)})});
}
inline Node wall(Node bsdf) {
    return node("shape", "rectangle",
                {{"to_world", Eigen::Matrix4d(translate({0, 2, 1}) * rotate_x(90) * scale(2, 2, 1))}},
                {std::move(bsdf)});
}
inline Node ball(double x, Node bsdf) {
    return node("shape", "sphere", {{"center", Vector3d(x, 0.3, 0.5)}, {"radius", 0.5}}, {std::move(bsdf)});
}
inline Node rough(double alpha = 0.3) {
    return node("bsdf", "roughconductor", {{"material", std::string("Au")}, {"alpha", alpha}});
}
inline Node camera() {
    return perspective(look_at({0.4, -4, 1.6}, {0, 0.5, 0.5}, {0, 0, 1}), 40, size, size, 4);
}

// Diffuse: area and point light, sky.
inline Node diffuse_scene() {
    return scene({path(5), camera(), lamp(4), floor(0.7), wall(node("bsdf", "diffuse", {uniform("reflectance", 0.5)})),
                  ball(0, node("bsdf", "diffuse", {uniform("reflectance", 0.8)})),
                  node("emitter", "constant", {uniform("radiance", 0.2)}),
                  node("emitter", "point", {{"position", Vector3d(-1.5, -1, 1.5)}, uniform("intensity", 1)}),
                  node("emitter", "directional", {{"direction", Vector3d(1, 1, -1)}, uniform("irradiance", 0.3)})});
}

// Polarized: rough gold surfaces light each other, at oblique angles.
inline Node glossy_scene() {
    return scene(
        {path(4), camera(), lamp(6, 0.8), floor(0.6), wall(rough(0.4)), ball(0.5, rough()), ball(-0.6, rough(0.5))});
}

// Polarized and specular: a glass and a gold ball, a polarizer and a quarter-wave plate before the lamp's light.
inline Node specular_scene() {
    const Node plate =
        node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, 1.6}) * scale(1.5, 1.5, 1))}},
             {node("bsdf", "polarizer", {{"theta", 30.0}})});
    const Node wave =
        node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, 1.4}) * scale(1.5, 1.5, 1))}},
             {node("bsdf", "retarder", {{"theta", 80.0}, {"delta", 90.0}})});
    return scene({path(6), camera(), lamp(6, 0.8), plate, wave, floor(0.6), wall(rough(0.4)),
                  ball(0.6, node("bsdf", "dielectric", {{"int_ior", 1.5}})),
                  ball(-0.6, node("bsdf", "conductor", {{"material", std::string("Al")}}))});
}

// Lamps of every kind, each polarized in another way, over rough metal.
inline Node polarized_lamps_scene() {
    const Value linear{"polarization", std::string("linear")}, circular{"polarization", std::string("circular")};
    const Node area =
        node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, 2}) * rotate_x(180))}},
             {node("emitter", "area", {uniform("radiance", 1), {"stokes", std::string("1, 0.5, 0.3, 0.6")}})});
    const Node point =
        node("emitter", "point", {{"position", Vector3d(-1.5, -1, 1.5)}, uniform("intensity", 1), linear});
    const Node spot = node("emitter", "spot",
                           {{"to_world", look_at({1.5, -2, 2}, {0.3, 0, 0}, {0, 0, 1})},
                            {"cutoff_angle", 40.0},
                            uniform("intensity", 3),
                            circular});
    const Node sun =
        node("emitter", "directional", {{"direction", Vector3d(1, 1, -1)}, uniform("irradiance", 0.3), linear});
    const Node sky = node("emitter", "constant", {uniform("radiance", 0.2), {"polarization", std::string("rayleigh")}});
    return scene({path(4), camera(), area, point, spot, sun, sky, floor(0.6), wall(rough(0.4)), ball(0.5, rough()),
                  ball(-0.6, rough(0.5))});
}

}  // namespace patina::render::test
