#pragma once
// Volumetric path tracing, `volumetric` (also `volpath`, `volpathmis`): path tracing through scattering and absorbing
// media, without bias, with Mueller matrices at surfaces and particles alike.
//
// Free flights and scattering angles are drawn from those of one of the path's four wavelengths, chosen in proportion
// to what each still carries; each wavelength is weighted by the density of that choice as a whole. Carried along a
// path this is the balance heuristic over the wavelengths as sampling techniques (Wilkie et al. 2014; the choice by
// throughput: Wrenninge, Villemin & Hery 2017, Path traced subsurface scattering), so that no wavelength's weight grows
// beyond four times what a path of its own would carry. Lights are sampled at surfaces and particles through any number
// of `null` boundaries, with multiple importance sampling; the chance of a ray to pass the medium unscattered belongs
// to the density of scattering.
//
// max_depth and rr_depth count segments between surfaces and particles as in path.h; a `null` surface is no event and
// begins no segment. On scenes without media, and without `null`, the picture is that of `path`.

#include "patina/render/integrators/integrator.h"

namespace patina::render {

class VolumetricIntegrator final : public Integrator {
  public:
    struct Settings {
        int max_depth = -1;
        int rr_depth = 5;
        bool hide_emitters = false;
    };
    explicit VolumetricIntegrator(const Settings& settings) : settings_(settings) {}

    void trace(const TransportProblem& problem, const Sensor::CameraRay& camera, const Wavelengths& wavelengths,
               Sampler& sampler, PathRecord& record) const override;
    bool follows_media() const override { return true; }

  private:
    Settings settings_;
};

}  // namespace patina::render
