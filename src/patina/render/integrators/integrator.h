#pragma once
// What every algorithm of light transport offers: the Stokes vector that arrives along a camera ray.

#include <memory>

#include "patina/core/properties.h"
#include "patina/render/random.h"
#include "patina/render/sensor.h"
#include "patina/render/spectrum.h"

namespace patina::render {

class Scene;

struct PathResult {
    StokesPacket stokes{};  // in the camera ray's frame, at the path's wavelengths
    bool hit = false;       // the camera ray met a surface
};

class Integrator {
  public:
    virtual ~Integrator() = default;
    virtual PathResult trace(const Scene& scene, const Sensor::CameraRay& camera, const Wavelengths& wavelengths,
                             Sampler& sampler) const = 0;
};

// The integrator a plugin names; `stokes` wraps another and changes nothing, for every picture here has Stokes
// components.
std::unique_ptr<Integrator> build_integrator(const Properties& node);

}  // namespace patina::render
