// The choice among many lamps: its probabilities are those with which it chooses, no lamp that shines is left out, and
// most choices go where most of the light comes from.

#include "patina/render/lamp_tree.h"

#include <random>

#include <gtest/gtest.h>

namespace patina::render {
namespace {

class RandomLamps {
  public:
    float number(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
    Vec3 point(const Vec3& low, const Vec3& high) {
        return {number(low.x(), high.x()), number(low.y(), high.y()), number(low.z(), high.z())};
    }
    // Panes that shine from one side, candles, and beams, all small.
    std::vector<LampBounds> mixed(int count) {
        std::vector<LampBounds> lamps(count);
        for (LampBounds& lamp : lamps) {
            lamp.centre = point(Vec3(-10, -10, -10), Vec3(10, 10, 10));
            lamp.power = number(0.1f, 10);
            const Vec3 axis = point(Vec3(-1, -1, -1), Vec3(1, 1, 1)).normalized();
            const float kind = number(0, 3);
            if (kind < 1) lamp.cone = {axis, 0, 0.5f * pi_f};
            if (kind > 2) lamp.cone = {axis, number(0.1f, 1.5f), 1e-3f};
        }
        return lamps;
    }

  private:
    std::mt19937 engine_{7};
};

bool shines(const LampBounds& lamp, const Vec3& at) {
    const float angle = std::acos(std::clamp((at - lamp.centre).normalized().dot(lamp.cone.axis), -1.0f, 1.0f));
    return lamp.cone.spread_rad >= pi_f || angle < lamp.cone.spread_rad + lamp.cone.reach_rad - 2e-3f;
}

TEST(LampTree, ChoosesWithTheProbabilitiesItStates) {
    RandomLamps random;
    const std::vector<LampBounds> lamps = random.mixed(40);
    const LampTree tree(lamps);
    constexpr int choices = 1 << 16;
    for (int i = 0; i < 5; ++i) {
        const Vec3 at = random.point(Vec3(-12, -12, -12), Vec3(12, 12, 12));
        std::vector<int> counts(lamps.size(), 0);
        for (int k = 0; k < choices; ++k) {
            const LampTree::Choice choice = tree.choose(at, (k + 0.5f) / choices);
            if (choice.lamp < 0) continue;
            ++counts[choice.lamp];
            ASSERT_NEAR(choice.probability, tree.probability(choice.lamp, at), 1e-6);
        }
        // A lamp owns two intervals of the unit line, whose four ends round to the grid.
        for (std::size_t l = 0; l < lamps.size(); ++l)
            EXPECT_NEAR(static_cast<double>(counts[l]) / choices, tree.probability(static_cast<int>(l), at),
                        4.0 / choices);
    }
}

// Bounds of branches must hold all their lamps: the walk reaches each that shines, on top of the choices by power
// alone.
TEST(LampTree, ReachesEveryLampThatShines) {
    RandomLamps random;
    const std::vector<LampBounds> lamps = random.mixed(60);
    const LampTree tree(lamps);
    float power = 0;
    for (const LampBounds& lamp : lamps) power += lamp.power;
    int lit = 0, dark = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec3 at = random.point(Vec3(-12, -12, -12), Vec3(12, 12, 12));
        for (std::size_t l = 0; l < lamps.size(); ++l) {
            const float by_power = 0.25f * lamps[l].power / power;
            const float probability = tree.probability(static_cast<int>(l), at);
            if (shines(lamps[l], at)) {
                ++lit;
                EXPECT_GT(probability, by_power * (1 + 1e-6f)) << l;
            } else if (probability < by_power * (1 + 1e-6f)) {
                ++dark;
            }
        }
    }
    EXPECT_GT(lit, 1000);
    EXPECT_GT(dark, 1000);  // and most of those that do not shine are not walked to
}

// Of a thousand candles over a plain, light I cos / r^2 of which a choice finds f / p: the relative variance of one
// choice, sum f^2/p / F^2 - 1, is some thirty by power alone, as only those near matter.
TEST(LampTree, SpendsItsChoicesWhereTheLightComesFrom) {
    RandomLamps random;
    std::vector<LampBounds> lamps(1000);
    for (LampBounds& lamp : lamps) {
        lamp.centre = random.point(Vec3(-40, -40, 2), Vec3(40, 40, 4));
        lamp.power = 1;
    }
    const LampTree tree(lamps);
    double by_tree = 0, by_power = 0;
    constexpr int points = 100;
    for (int i = 0; i < points; ++i) {
        const Vec3 at = random.point(Vec3(-30, -30, 0), Vec3(30, 30, 0));
        double total = 0, tree_square = 0, power_square = 0;
        for (std::size_t l = 0; l < lamps.size(); ++l) {
            const Vec3 d = lamps[l].centre - at;
            const double light = d.z() / std::pow(d.norm(), 3.0);
            total += light;
            tree_square += light * light / tree.probability(static_cast<int>(l), at);
            power_square += light * light * static_cast<double>(lamps.size());
        }
        by_tree += (tree_square / (total * total) - 1) / points;
        by_power += (power_square / (total * total) - 1) / points;
    }
    EXPECT_GT(by_power, 10);
    EXPECT_LT(by_tree, 0.1 * by_power);
}

}  // namespace
}  // namespace patina::render
