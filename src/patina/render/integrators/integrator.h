#pragma once
// What every algorithm of light transport offers: the Stokes vectors that arrive along a camera ray, by class of path.

#include <map>
#include <memory>
#include <span>
#include <string>

#include "patina/core/progress.h"
#include "patina/core/properties.h"
#include "patina/render/integrators/light_path_expression.h"
#include "patina/render/integrators/path_record.h"
#include "patina/render/random.h"
#include "patina/render/sensor.h"
#include "patina/render/spectrum.h"

namespace patina::render {

class Scene;

// What all samples of a picture share.
struct TransportProblem {
    const Scene& scene;
    const Sensor& sensor;
    const LightPathClassifier& classes;
};

// One sample of the picture: the ray to follow and where its light goes.
struct CameraSample {
    Sensor::CameraRay camera;
    Wavelengths wavelengths;
    Sampler sampler;
    PathRecord* record = nullptr;
};

class Integrator {
  public:
    virtual ~Integrator() = default;

    // Work before the first sample. Throws Error(input) for scenes that the method cannot do.
    virtual void prepare(const TransportProblem&, const JobControl&) {}
    // Adds one sample to the record. Its wavelengths are those of the splats as well.
    virtual void trace(const TransportProblem& problem, const Sensor::CameraRay& camera, const Wavelengths& wavelengths,
                       Sampler& sampler, PathRecord& record) const = 0;
    // The same for several samples, which a method may trace side by side; each brings what it brings alone.
    virtual void trace_block(const TransportProblem& problem, std::span<CameraSample> samples) const {
        for (CameraSample& s : samples) trace(problem, s.camera, s.wavelengths, s.sampler, *s.record);
    }

    // Samples write to pixels other than their own.
    virtual bool splats() const { return false; }
    // Knows what is between surfaces; others refuse scenes with media.
    virtual bool follows_media() const { return false; }
    // Every contribution is one path whose events are known.
    virtual bool knows_paths() const { return true; }
    // For the picture's metadata.
    virtual std::map<std::string, std::string> notes() const { return {}; }
};

// The integrator a plugin names, or wraps: `stokes` changes nothing, for every picture here has Stokes components;
// `aov` adds channels to the picture (aov.h).
std::unique_ptr<Integrator> build_integrator(const Properties& node);

// The integrator at work inside any number of wrappers. Throws Error(input) for a wrapper of nothing.
bool is_wrapper(const Properties& integrator);
const Properties& wrapped_integrator(const Properties& integrator);

}  // namespace patina::render
