#pragma once
// Which of many lamps to look at from a point: a binary tree over the lamps that are somewhere, walked from the root
// towards the branch that sends more light to the point, as its power over the square of the distance has it, within
// the directions it shines into at all (Conty & Kulla 2018, Importance sampling of many lights with adaptive tree
// splitting, the bounds of section 4.1).
//
// The tree knows neither shadows nor the surface that receives: a share of the choices goes by power alone, so that a
// lamp which is near in vain costs no more than that.

#include <vector>

#include "patina/render/sampling.h"
#include "patina/render/vec.h"

namespace patina::render {

// Directions within `spread` of an axis, and the light that Lambert's law sends up to `reach` beyond them.
struct LightCone {
    Vec3 axis = Vec3::UnitZ();
    float spread_rad = pi_f;
    float reach_rad = 0.5f * pi_f;
};

// What the choice knows of a lamp: a sphere that holds it, its power, and where it shines.
struct LampBounds {
    Vec3 centre = Vec3::Zero();
    float radius = 0;
    float power = 0;
    LightCone cone;
};

class LampTree {
  public:
    LampTree() = default;
    explicit LampTree(const std::vector<LampBounds>& lamps);

    struct Choice {
        int lamp = -1;  // -1: no lamp shines here
        float probability = 0;
    };
    Choice choose(const Vec3& from, float u) const;
    // With which choose() finds this lamp.
    float probability(int lamp, const Vec3& from) const;

  private:
    static constexpr float share_by_power = 0.25f;

    struct Node {
        LampBounds bounds;
        float sin_spread = 0, cos_spread = -1, cos_reach = 0;  // of the cone
        int left = -1, right = -1, parent = -1;                // nodes, -1: none
        int lamp = -1;                                         // of a leaf
    };
    int build(const std::vector<LampBounds>& lamps, std::vector<int>::iterator begin, std::vector<int>::iterator end);
    static Node node_of(const LampBounds& bounds);
    static float importance(const Node& node, const Vec3& from);
    // Share of a node's choices that go to its left child; negative when neither child shines here.
    float share_of_left(const Node& node, const Vec3& from) const;

    Choice walk(const Vec3& from, float u) const;
    float walk_probability(int lamp, const Vec3& from) const;

    DiscreteDistribution by_power_;  // of the lamps
    std::vector<Node> nodes_;        // children before their parent, the root last
    std::vector<int> leaf_;          // of a lamp
};

}  // namespace patina::render
