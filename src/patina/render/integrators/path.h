#pragma once
// Path tracing, `path`: Kajiya (1986), with light sampling and multiple importance sampling (Veach 1997), Mueller
// matrices along the path.
//
// max_depth counts the segments of a path as Mitsuba does: 1 shows emitters only, 2 adds direct light, -1 is no limit.
// From rr_depth segments on paths are ended at random in proportion to what they still carry, at least one in twenty.

#include "patina/render/integrators/integrator.h"

namespace patina::render {

class PathIntegrator final : public Integrator {
  public:
    struct Settings {
        int max_depth = -1;
        int rr_depth = 5;
        bool hide_emitters = false;
    };
    explicit PathIntegrator(const Settings& settings) : settings_(settings) {}

    void trace(const TransportProblem& problem, const Sensor::CameraRay& camera, const Wavelengths& wavelengths,
               Sampler& sampler, PathRecord& record) const override;
    void trace_block(const TransportProblem& problem, std::span<CameraSample> samples) const override;

  private:
    Settings settings_;
};

}  // namespace patina::render
