#pragma once
// The shim around Embree: the only place that knows its interface (version 3; version 4 differs in names only).

#include <memory>
#include <span>
#include <vector>

#include "patina/render/shapes.h"

namespace patina::render {

class Geometry;

class EmbreeScene {
  public:
    // The geometry's meshes and instances and, when given, analytic shapes as user geometry. Its arrays must outlive
    // this object, unmoved.
    EmbreeScene(const Geometry& geometry, std::span<const AnalyticShape> analytic);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    // Updates `hit` when something is nearer than hit.t.
    bool intersect(const Ray& ray, Hit& hit) const;
    bool occluded(const Ray& ray) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace patina::render
