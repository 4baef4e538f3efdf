// Throughputs of chains of events at random angles are realizable; with one sign wrong they are not.

#include "patina/render/realizability.h"

#include <random>

#include <gtest/gtest.h>

#include "patina/core/constants.h"

namespace patina::render {
namespace {

// A path of mirrors at random places: Fresnel reflection off a metal, between frames named at random.
Throughput chain(int events, int wrong_event, std::mt19937& random) {
    std::uniform_real_distribution<float> uniform(0, 1);
    const auto direction = [&] {
        const float z = 2 * uniform(random) - 1, phi = 2 * static_cast<float>(pi) * uniform(random),
                    r = std::sqrt(1 - z * z);
        return Vec3(r * std::cos(phi), r * std::sin(phi), z);
    };
    Vec3 out = direction();
    Throughput path(out.unitOrthogonal());
    for (int e = 0; e < events; ++e) {
        const Vec3 next = direction(), s = out.cross(next).normalized();
        // (|r_p|^2 +- |r_s|^2)/2, Re and Im of r_p r_s*, for amplitudes of modulus below 1.
        const float p = uniform(random), q = uniform(random), phase = 6 * uniform(random);
        ScatteringMatrix m;
        m.set_fresnel(splat(0.5f * (p * p + q * q)), splat(0.5f * (p * p - q * q)), splat(p * q * std::cos(phase)),
                      splat(p * q * std::sin(phase)), s, s);
        if (e == wrong_event) {
            // The sense of rotation forgotten on one side.
            const optics::Mueller full = m.matrix(0);
            m.form = ScatteringMatrix::Form::general;
            for (int i = 0; i < 16; ++i) m.m[i] = splat(static_cast<float>(full(i % 4, i / 4) * (i % 4 == 3 ? -1 : 1)));
        }
        path.append(m, out);
        out = next;
    }
    return path;
}

TEST(Realizability, OfChainsOfEvents) {
    std::mt19937 random(3);
    int found = 0;
    for (int trial = 0; trial < 50; ++trial) {
        EXPECT_TRUE(is_realizable(chain(6, -1, random)));
        found += !is_realizable(chain(3, 0, random));
    }
    // Weak events hide the mistake now and then.
    EXPECT_GT(found, 40);
}

// What crossed polarizers leave is rounding, which need not be realizable.
TEST(Realizability, CrossedPolarizersExtinguish) {
    const auto polarizer = [](float angle) {
        ScatteringMatrix m;
        const Vec3 axis(std::cos(angle), std::sin(angle), 0);
        m.set_fresnel(splat(0.5f), splat(0.5f), splat(0), splat(0), axis, axis);
        return m;
    };
    const Vec3 along = Vec3::UnitZ();
    Throughput before(Vec3::UnitX());
    before.append(polarizer(0.3f), along);
    for (const auto& [angle, dark] :
         {std::pair(0.3f, false), std::pair(1.0f, false), std::pair(0.3f + 1.5707963f, true)}) {
        Throughput after = before;
        after.append(polarizer(angle), along);
        EXPECT_EQ(extinguishes(polarizer(angle), before, after), dark) << angle;
    }
}

TEST(Realizability, AMirrorThatKeepsTheSenseOfRotationOnOneSideIsNone) {
    ScatteringMatrix m;
    m.form = ScatteringMatrix::Form::general;
    for (Float4& value : m.m) value = splat(0);
    for (int i = 0; i < 4; ++i) m.m[5 * i] = splat(i == 3 ? -1.0f : 1.0f);
    EXPECT_FALSE(is_realizable(m));
    m.m[10] = splat(-1);
    EXPECT_TRUE(is_realizable(m));
    m.m[0] = splat(NAN);
    EXPECT_FALSE(is_realizable(m));
}

}  // namespace
}  // namespace patina::render
