#pragma once
// Copies of groups of shapes, at rest or moving while the shutter is open.

#include <vector>

#include "patina/render/shapes.h"

namespace patina::render {

// The analytic shapes of a group in its own space; its meshes carry the group's index (geometry.h).
struct ShapeGroup {
    int first = 0, count = 0;  // of Geometry::group_analytic
    Eigen::AlignedBox3f box;   // of everything in it
};

struct Instance {
    int group = -1;
    // To the world at equidistant times over the shutter's opening; one: at rest. Between two times the matrices are
    // interpolated linearly, as Embree does.
    std::vector<Eigen::Matrix4f> to_world;

    Eigen::Matrix4f at(float time) const;  // 0: the shutter opens, 1: it closes
    Eigen::AlignedBox3f bounds(const Eigen::AlignedBox3f& group_box) const;
};

// An instance's path through a few given transforms at ascending times: translation and stretch linear, rotation along
// the great circle (Shoemake & Duff 1992, Matrix animation and polar decomposition), held before the first and after
// the last. `count` transforms, equidistant from `open` to `close`.
std::vector<Eigen::Matrix4f> sample_animation(const std::vector<double>& times_s,
                                              const std::vector<Eigen::Matrix4d>& transforms, double open, double close,
                                              int count);

}  // namespace patina::render
