#include "patina/render/instance_builder.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

// Transforms over the shutter's opening; between two the matrices are linear: a quarter turn then errs by 1e-3.
constexpr int steps_while_open = 17;

void expect_invertible(const Eigen::Matrix4d& m, const SourceLocation& where) {
    const double determinant = m.block<3, 3>(0, 0).determinant();
    const double size = m.block<3, 3>(0, 0).norm();
    if (!m.allFinite() || !(std::abs(determinant) > 1e-18 * size * size * size) ||
        !(m.row(3) == Eigen::RowVector4d(0, 0, 0, 1)))
        throw input_error(where, "the transform is degenerate");
}

bool moves(const Properties& node) {
    const auto to_world = node.named_child("to_world");
    return to_world && to_world->category == "animation";
}

}  // namespace

bool InstanceBuilder::add(const Properties& node) {
    const bool moving = moves(node);
    if (node.type != "shapegroup" && node.type != "instance" && !moving) return false;
    if (node.type == "shapegroup") {
        if (moving)
            throw input_error(node.named_child("to_world")->where, "a group does not move", "", "move its instances");
        group_of(node);
        return true;
    }
    Copy copy = copy_of(node);
    if (node.type == "instance") {
        const auto group = node.only_child("shape");
        if (!group || group->type != "shapegroup")
            throw input_error(node.where, "an instance shows a shapegroup",
                              group ? fmt::format("it names a \"{}\"", group->type) : "it names none",
                              "write <ref id=\"...\"/> with the group's id");
        copy.group = group_of(*group);
        expect_known_properties(node);
    } else {
        copy.group = begin_group();
        build_shape_(node, copy.group);
        end_group(copy.group);
    }
    copies_.push_back(std::move(copy));
    return true;
}

int InstanceBuilder::begin_group() {
    geometry_.groups.push_back({static_cast<int>(geometry_.group_analytic.size()), 0, {}});
    return static_cast<int>(geometry_.groups.size()) - 1;
}

void InstanceBuilder::end_group(int group) {
    geometry_.groups[group].count = static_cast<int>(geometry_.group_analytic.size()) - geometry_.groups[group].first;
}

int InstanceBuilder::group_of(const Properties& node) {
    if (const auto known = groups_.find(&node); known != groups_.end()) return known->second;
    expect_plugin(node);
    const int group = begin_group();
    const auto shapes = node.children_of("shape");
    if (shapes.empty()) throw input_error(node.where, "the group has no shapes");
    for (const auto& shape : shapes) {
        if (moves(*shape) || shape->type == "shapegroup" || shape->type == "instance")
            throw input_error(shape->where, "a group holds plain shapes at rest",
                              fmt::format("this is a {}\"{}\"", moves(*shape) ? "moving " : "", shape->type));
        build_shape_(*shape, group);
    }
    end_group(group);
    expect_known_properties(node);
    return groups_[&node] = group;
}

InstanceBuilder::Copy InstanceBuilder::copy_of(const Properties& node) const {
    Copy copy{-1, {}, {}, node.location_of("to_world")};
    if (moves(node)) {
        const auto animation = node.named_child("to_world");
        for (std::size_t i = 0; i < animation->entries.size() / 2; ++i) {
            copy.times_s.push_back(animation->number(fmt::format("time_{}", i)));
            copy.transforms.push_back(animation->transform(fmt::format("transform_{}", i)));
        }
        copy.where = animation->where;
    } else {
        copy.times_s = {0.0};
        copy.transforms = {node.transform("to_world")};
    }
    for (const Eigen::Matrix4d& m : copy.transforms) expect_invertible(m, copy.where);
    return copy;
}

void InstanceBuilder::place(double open_s, double close_s) {
    for (const Copy& copy : copies_) {
        const bool moves = copy.times_s.size() > 1 && close_s > open_s;
        Instance instance{
            copy.group, sample_animation(copy.times_s, copy.transforms, open_s, close_s, moves ? steps_while_open : 1)};
        for (const Eigen::Matrix4f& m : instance.to_world) expect_invertible(m.cast<double>(), copy.where);
        geometry_.instances.push_back(std::move(instance));
    }
    copies_.clear();
}

}  // namespace patina::render
