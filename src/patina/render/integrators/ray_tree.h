#pragma once
// Ray tracing as a tree, before path tracing: the algorithms that follow some kinds of scattering and no others.
//
//   appel         E(D|G)L               Appel (1968): visible surfaces, direct light with shadows
//   whitted       ES*(D|G)L             Whitted (1980): also mirrors and refraction, both followed at an interface
//   distribution  E(S|G)*(D|G)?L        Cook, Porter & Carpenter (1984): rays spread over lamps, lobes and the lens
//
// Each is the full light of its paths, polarized, by light and lobe sampling under multiple importance sampling; the
// rest of the light is left out. appel and whitted show lamps (EL, ES*L) only with hide_emitters = false.

#include "patina/render/integrators/integrator.h"

namespace patina::render {

class RayTreeIntegrator final : public Integrator {
  public:
    struct Settings {
        bool follow_specular = false, follow_glossy = false;
        int max_depth = -1;  // segments, as in path.h
        int rr_depth = 5;
        bool hide_emitters = true;
        int light_samples = 1;  // shadow rays at the first surface
        int lobe_samples = 1;   // rays into the lobe of the first surface
    };
    explicit RayTreeIntegrator(const Settings& settings) : settings_(settings) {}

    void trace(const TransportProblem& problem, const Sensor::CameraRay& camera, const Wavelengths& wavelengths,
               Sampler& sampler, PathRecord& record) const override;

  private:
    Settings settings_;
};

}  // namespace patina::render
