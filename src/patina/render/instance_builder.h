#pragma once
// Groups of shapes and their copies from the nodes of a scene file.
//
//   <shape type="shapegroup" id="tree"> shapes </shape>      is not seen itself
//   <shape type="instance"> <ref id="tree"/> to_world </shape>
//
// An instance, or any other shape, may move: <animation name="to_world"> in place of its transform.

#include <functional>
#include <map>

#include "patina/core/properties.h"
#include "patina/render/geometry.h"

namespace patina::render {

class InstanceBuilder {
  public:
    // Builds a shape into a group.
    using BuildShape = std::function<void(const Properties&, int group)>;

    InstanceBuilder(Geometry& geometry, BuildShape build_shape)
        : geometry_(geometry), build_shape_(std::move(build_shape)) {}

    // A `shapegroup`, an `instance`, or a shape that moves; false: something else.
    bool add(const Properties& node);
    // Once the shutter is known, seconds.
    void place(double open_s, double close_s);

  private:
    struct Copy {
        int group;
        std::vector<double> times_s;
        std::vector<Eigen::Matrix4d> transforms;
        SourceLocation where;
    };
    int group_of(const Properties& node);
    Copy copy_of(const Properties& node) const;
    int begin_group();
    void end_group(int group);

    Geometry& geometry_;
    BuildShape build_shape_;
    std::map<const Properties*, int> groups_;
    std::vector<Copy> copies_;
};

}  // namespace patina::render
