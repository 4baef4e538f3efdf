#include "patina/render/lamp_tree.h"

#include <numeric>
#include <span>

namespace patina::render {

namespace {

float angle_between(const Vec3& a, const Vec3& b) {
    return std::acos(std::clamp(a.dot(b), -1.0f, 1.0f));
}

// The narrowest cone about both: the wider one where it holds the other, else one that touches both.
LightCone united(const LightCone& a, const LightCone& b) {
    if (b.spread_rad > a.spread_rad) return united(b, a);
    const float reach = std::max(a.reach_rad, b.reach_rad), between = angle_between(a.axis, b.axis);
    if (std::min(between + b.spread_rad, pi_f) <= a.spread_rad) return {a.axis, a.spread_rad, reach};
    const float spread = 0.5f * (a.spread_rad + between + b.spread_rad);
    const Vec3 across = b.axis - a.axis.dot(b.axis) * a.axis;
    if (spread >= pi_f || across.norm() < 1e-3f) return {a.axis, pi_f, reach};
    const float turn = spread - a.spread_rad;
    return {(std::cos(turn) * a.axis + std::sin(turn) * across.normalized()).normalized(), spread, reach};
}

// The sphere about the box that holds some lamps; their power, and where any of them shines.
template <class Lamps>
LampBounds bounds_of(const std::vector<LampBounds>& lamps, const Lamps& some) {
    LampBounds all = lamps[some.front()];
    Vec3 low = all.centre, high = low;
    all.power = 0;
    for (const int l : some) {
        const LampBounds& lamp = lamps[l];
        low = low.cwiseMin(lamp.centre - Vec3::Constant(lamp.radius));
        high = high.cwiseMax(lamp.centre + Vec3::Constant(lamp.radius));
        all.power += lamp.power;
        all.cone = united(all.cone, lamp.cone);
    }
    all.centre = 0.5f * (low + high);
    all.radius = 0.5f * (high - low).norm();
    return all;
}

// Cosine of the angle (sin_a, cos_a) less the angle (sin_b, cos_b), both of 0 .. pi; 1 where the second is larger.
float cos_of_difference(float sin_a, float cos_a, float sin_b, float cos_b) {
    return cos_a >= cos_b ? 1.0f : cos_a * cos_b + sin_a * sin_b;
}
float sin_of(float cos) {
    return safe_sqrt(1 - cos * cos);
}

}  // namespace

LampTree::LampTree(const std::vector<LampBounds>& lamps) : leaf_(lamps.size()) {
    std::vector<int> order(lamps.size());
    std::iota(order.begin(), order.end(), 0);
    nodes_.reserve(2 * lamps.size());
    if (lamps.empty()) return;
    build(lamps, order.begin(), order.end());
    std::vector<double> powers;
    for (const LampBounds& lamp : lamps) powers.push_back(lamp.power);
    if (nodes_.back().bounds.power <= 0) powers.assign(powers.size(), 1.0);  // dark, whichever is chosen
    by_power_ = DiscreteDistribution(powers);
}

// Halves the lamps along the axis in which their centres spread most.
int LampTree::build(const std::vector<LampBounds>& lamps, std::vector<int>::iterator begin,
                    std::vector<int>::iterator end) {
    if (end - begin == 1) {
        Node& leaf = nodes_.emplace_back(node_of(lamps[*begin]));
        leaf.lamp = *begin;
        return leaf_[*begin] = static_cast<int>(nodes_.size()) - 1;
    }
    Vec3 low = lamps[*begin].centre, high = low;
    for (auto lamp = begin; lamp != end; ++lamp) {
        low = low.cwiseMin(lamps[*lamp].centre);
        high = high.cwiseMax(lamps[*lamp].centre);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [&](int a, int b) {
        const float at_a = lamps[a].centre[axis], at_b = lamps[b].centre[axis];
        return at_a != at_b ? at_a < at_b : a < b;
    });
    const int left = build(lamps, begin, middle), right = build(lamps, middle, end);
    Node& node = nodes_.emplace_back(node_of(bounds_of(lamps, std::span(begin, end))));
    node.left = left;
    node.right = right;
    return nodes_[left].parent = nodes_[right].parent = static_cast<int>(nodes_.size()) - 1;
}

LampTree::Node LampTree::node_of(const LampBounds& bounds) {
    Node node;
    node.bounds = bounds;
    node.sin_spread = std::sin(bounds.cone.spread_rad);
    node.cos_spread = std::cos(bounds.cone.spread_rad);
    node.cos_reach = std::cos(bounds.cone.reach_rad);
    return node;
}

// Power over the square of the distance, times the largest cosine with which any of the lamps may shine this way. Among
// lamps spread over a ball the mean of 1 / distance^2 is 3 / radius^2 at its centre.
float LampTree::importance(const Node& node, const Vec3& from) {
    const LampBounds& bounds = node.bounds;
    const Vec3 d = from - bounds.centre;
    const float distance2 = d.squaredNorm(), radius2 = bounds.radius * bounds.radius;
    const float light = bounds.power / std::max(distance2 + radius2 / 3, 1e-20f);
    if (bounds.cone.spread_rad >= pi_f || distance2 <= radius2) return light;
    const float cos_axis = d.dot(bounds.cone.axis) / std::sqrt(distance2);
    const float cos_beyond = cos_of_difference(sin_of(cos_axis), cos_axis, node.sin_spread, node.cos_spread);
    const float sin2_size = radius2 / distance2;
    const float cos = cos_of_difference(sin_of(cos_beyond), cos_beyond, std::sqrt(sin2_size), std::sqrt(1 - sin2_size));
    return cos > node.cos_reach ? light * std::max(cos, 0.0f) : 0.0f;
}

float LampTree::share_of_left(const Node& node, const Vec3& from) const {
    const float left = importance(nodes_[node.left], from), right = importance(nodes_[node.right], from);
    return left + right > 0 ? left / (left + right) : -1.0f;
}

LampTree::Choice LampTree::choose(const Vec3& from, float u) const {
    Choice choice;
    if (u < share_by_power) {
        choice.lamp = by_power_.sample(u / share_by_power).index;
        choice.probability = walk_probability(choice.lamp, from);
    } else {
        choice = walk(from, std::min((u - share_by_power) / (1 - share_by_power), 0x1.fffffep-1f));
        if (choice.lamp < 0) return choice;
    }
    choice.probability =
        share_by_power * by_power_.probability(choice.lamp) + (1 - share_by_power) * choice.probability;
    return choice;
}

float LampTree::probability(int lamp, const Vec3& from) const {
    return share_by_power * by_power_.probability(lamp) + (1 - share_by_power) * walk_probability(lamp, from);
}

LampTree::Choice LampTree::walk(const Vec3& from, float u) const {
    const Node* node = &nodes_.back();
    float probability = 1;
    while (node->lamp < 0) {
        const float left = share_of_left(*node, from);
        if (left < 0) return {};
        const bool goes_left = u < left;
        const float share = goes_left ? left : 1 - left;
        u = std::min((goes_left ? u : u - left) / share, 0x1.fffffep-1f);
        probability *= share;
        node = &nodes_[goes_left ? node->left : node->right];
    }
    return {node->lamp, probability};
}

float LampTree::walk_probability(int lamp, const Vec3& from) const {
    float probability = 1;
    for (int child = leaf_[lamp]; nodes_[child].parent >= 0; child = nodes_[child].parent) {
        const Node& node = nodes_[nodes_[child].parent];
        const float left = share_of_left(node, from);
        if (left < 0) return 0;
        probability *= node.left == child ? left : 1 - left;
    }
    return probability;
}

}  // namespace patina::render
