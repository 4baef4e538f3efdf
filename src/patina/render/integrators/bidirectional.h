#pragma once
// Paths from both ends.
//
//   bidirectional  Veach & Guibas (1994), Lafortune & Willems (1993): every way to join a path from the camera with
//                  one from a lamp, weighted by the power heuristic (Veach 1997, section 10.2)
//   light          Dutre & Willems (1994), the adjoint equation: paths from the lamps, each surface they meet joined
//                  with the camera; what the camera sees of the lamps themselves comes along its own rays
//
// Camera paths carry Mueller matrices, light paths Stokes vectors; both are multiplied in the order light travels.
// Light tracing cannot see mirrors and glass (E S ... L): no path from a lamp meets a pinhole by way of a delta
// function. It leaves those paths out; bidirectional has them all.

#include <optional>

#include "patina/render/emission.h"
#include "patina/render/integrators/integrator.h"

namespace patina::render {

class BidirectionalIntegrator final : public Integrator {
  public:
    struct Settings {
        bool light_only = false;
        int max_depth = -1;  // segments, as in path.h
        int rr_depth = 5;
        bool hide_emitters = false;
    };
    explicit BidirectionalIntegrator(const Settings& settings) : settings_(settings) {}

    void prepare(const TransportProblem& problem, const JobControl& control) override;
    void trace(const TransportProblem& problem, const Sensor::CameraRay& camera, const Wavelengths& wavelengths,
               Sampler& sampler, PathRecord& record) const override;
    bool splats() const override { return true; }

  private:
    Settings settings_;
    std::optional<Emission> emission_;
};

}  // namespace patina::render
