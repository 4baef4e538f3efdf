#pragma once
// Surface scattering: what every model offers, the closed set of models, and the registry that names them.
//
// Directions are unit vectors in the local shading frame (z = shading normal) that point away from the surface:
// `outgoing` towards the camera's side of the path, `incident` towards where the light comes from. Matrices are Mueller
// BSDFs in the renderer's convention (stokes_frames.h), between frames they name themselves, for light that arrives
// along -incident and leaves along +outgoing. Radiance, not importance: refraction scales it by the square of the
// relative index.

#include <concepts>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "patina/core/properties.h"
#include "patina/render/mueller_packet.h"
#include "patina/render/render.h"
#include "patina/render/spectrum.h"
#include "patina/render/surface_uv.h"

namespace patina::render {

struct Bsdf;

// Where on a surface, and for which wavelengths, a model is asked.
struct ShadingPoint {
    const Wavelengths* wavelengths = nullptr;
    SurfaceUv uv;
    const Bsdf* set = nullptr;  // the scene's models, for those that are made of others
    // evaluate(), and sample() of a paint, need not fill but the first column of a general matrix.
    bool unpolarized_light = false;
    // sample() of a smooth interface takes each of its two ways with at least this probability.
    float least_share = 0;

    // With which probability one that reflects this share of the light is to reflect the path.
    float chance_of_reflection(float reflectance) const {
        constexpr float no_way = 1e-4f;
        if (reflectance < no_way || reflectance > 1 - no_way) return reflectance;
        return std::clamp(reflectance, least_share, 1 - least_share);
    }
};

struct BsdfSample {
    Vec3 incident;
    float pdf = 0;  // per solid angle of `incident`; for a delta event the probability of having chosen it
    bool delta = false;
    bool dispersed = false;   // the direction is right for the hero wavelength only
    float eta = 1;            // index of the incident side over that of the outgoing side
    float adjoint = 1;        // delta events: factor on flux that runs from `outgoing` to `incident` (normal maps)
    ScatteringMatrix weight;  // BSDF times |cos incident| over pdf
};

struct BsdfValue {
    ScatteringMatrix f;  // BSDF times |cos incident|, delta parts left out
    float pdf = 0;       // density with which sample() finds `incident`, per solid angle
};

// A model of the scene's set and its dispatch (bsdf_set.h), for models made of models.
const Bsdf& nested_bsdf(const ShadingPoint& point, int index);
bool bsdf_sample(const Bsdf& bsdf, const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2,
                 BsdfSample& sample);
bool bsdf_evaluate(const Bsdf& bsdf, const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident,
                   BsdfValue& value);
bool bsdf_is_delta(const Bsdf& bsdf, const ShadingPoint& point);

template <class Model>
concept BsdfModel = requires(const Model model, const ShadingPoint& point, const Vec3& direction, float u,
                             const Vec2& u2, BsdfSample& sample, BsdfValue& value) {
    // Draws `incident`; false: the path ends here.
    { model.sample(point, direction, u, u2, sample) } -> std::same_as<bool>;
    // False: zero for this pair.
    { model.evaluate(point, direction, direction, value) } -> std::same_as<bool>;
    // No part but delta functions: no use in sampling lights.
    { model.is_delta(point) } -> std::same_as<bool>;
};

// The end of sample() where several lobes may have led to sample.incident: weight and density are those of evaluate().
template <class Model>
bool weigh_by_all_lobes(const Model& model, const ShadingPoint& point, const Vec3& outgoing, BsdfSample& sample) {
    BsdfValue value;
    if (!model.evaluate(point, outgoing, sample.incident, value) || !(value.pdf > 0)) return false;
    sample.pdf = value.pdf;
    sample.weight = value.f;
    sample.weight.scale(splat(1 / value.pdf));
    return true;
}

// What a model's constructor from a scene file is given.
struct BsdfBuilder {
    const SceneResources* resources;
    std::function<int(const std::shared_ptr<const Properties>&)> nested;  // index of a model inside a model
    std::map<std::string, std::string>* notes;  // provenance that belongs into the picture's metadata
};

}  // namespace patina::render
