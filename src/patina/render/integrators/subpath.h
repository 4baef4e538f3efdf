#pragma once
// The two halves of a bidirectional path, vertex by vertex.

#include <vector>

#include "patina/render/emission.h"
#include "patina/render/integrators/integrator.h"
#include "patina/render/integrators/scattering_event.h"
#include "patina/render/light_beam.h"
#include "patina/render/scene.h"

namespace patina::render {

// A point of a half path. Densities are per area; per solid angle for light from infinity, 1 for a point.
struct PathVertex {
    enum class Kind { camera, surface, light, infinity };
    Kind kind = Kind::surface;
    Hit hit;
    SurfacePoint point;                // the camera and lamps: its position alone
    Vec3 to_previous = Vec3::Zero();   // unit, towards the end the half path came from
    bool delta = false;                // the half path went on by a delta function
    ScatteringEvent event{};           // by which it went on
    double forward = 0, backward = 0;  // density of this vertex from its own half path's side, from the other side
    bool hero_only = false;            // what arrives here is right for one wavelength
    int emitter = -1;                  // of a lamp at the beginning of a light path, or of the surface

    // Camera paths: what arrives here seen by the camera, the classifier's state before this vertex's event.
    Throughput throughput{Vec3::UnitX()};
    int events = LightPathClassifier::eye;
    // Light paths: the light that arrives, as flux.
    LightBeam beam;

    const Vec3& position() const { return point.position; }
};

// What the two halves of a sample share.
struct SubpathContext {
    const TransportProblem& problem;
    const Wavelengths& w;
    const Emission& emission;
    int rr_depth;
    float time;  // of the sample: both halves see the same moment

    const Scene& scene() const { return problem.scene; }
    const Bsdf& bsdf(const PathVertex& v) const { return scene().bsdfs[scene().geometry.shapes[v.point.shape].bsdf]; }
    ShadingPoint shading(const PathVertex& v) const { return {&w, v.point.uv, scene().bsdfs.data()}; }
    bool only_delta(const PathVertex& v) const { return bsdf_is_delta(bsdf(v), shading(v)); }
    ScatteringEvent event(const PathVertex& v, const Vec3& outgoing) const {
        return continuous_event(bsdf(v), shading(v), v.point.frame.to_local(outgoing));
    }
    // BSDF times cos(incident), axes in the world, for light that comes from `incident` and leaves to `outgoing`;
    // false: zero.
    bool evaluate(const PathVertex& v, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const;
    // Density with which a path that arrived from `from` goes on towards `to`.
    float pdf(const PathVertex& v, const Vec3& from, const Vec3& to) const;
};

// Turns a density per solid angle at a point into one per area of the surface at `to`.
inline double per_area(double per_solid_angle, const Vec3& from, const PathVertex& to) {
    if (to.kind == PathVertex::Kind::infinity) return per_solid_angle;
    const Vec3 d = to.position() - from;
    const double distance2 = d.squaredNorm();
    if (!(distance2 > 0)) return 0;
    const double cos = to.kind == PathVertex::Kind::surface || !to.point.geometric_normal.isZero()
                           ? std::abs(static_cast<double>(to.point.geometric_normal.dot(d))) / std::sqrt(distance2)
                           : 1.0;
    return per_solid_angle * cos / distance2;
}

// Vertex 0 is the camera; the last may be at infinity.
void trace_camera_path(const SubpathContext& context, const Sensor::CameraRay& camera, int most_vertices,
                       Sampler& sampler, std::vector<PathVertex>& path);
// Vertex 0 is the lamp; empty when it does not shine.
void trace_light_path(const SubpathContext& context, int most_vertices, Sampler& sampler,
                      std::vector<PathVertex>& path);

}  // namespace patina::render
