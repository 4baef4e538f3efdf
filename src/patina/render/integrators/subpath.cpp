#include "patina/render/integrators/subpath.h"

namespace patina::render {

namespace {

// Random draws: the camera's own, then eight a vertex; light paths draw from a range of their own.
constexpr std::uint32_t first_camera_draw = 8, first_light_draw = 1u << 20, draws_per_vertex = 8;

void axes_to_world(const SurfacePoint& point, ScatteringMatrix& m) {
    if (m.form == ScatteringMatrix::Form::depolarizing) return;
    m.x_in = point.frame.to_world(m.x_in);
    m.x_out = point.frame.to_world(m.x_out);
}

PathVertex infinite_vertex(const Vec3& direction) {
    PathVertex v;
    v.kind = PathVertex::Kind::infinity;
    v.to_previous = -direction;
    return v;
}

// The surface that a ray meets; false: none.
bool meet(const Scene& scene, const Ray& ray, PathVertex& v) {
    if (!scene.geometry.intersect(ray, v.hit)) return false;
    v.point = scene.geometry.surface(ray, v.hit);
    v.to_previous = -ray.direction;
    v.emitter = scene.geometry.shapes[v.point.shape].emitter;
    return true;
}

// Sets the density of the vertex before `at`, found from the vertex after it: the delta function's factor is common to
// both ways and left out.
void set_backward(const SubpathContext& context, PathVertex& before, const PathVertex& at, const Vec3& from) {
    const float pdf = at.delta ? 1.0f : context.pdf(at, from, at.to_previous);
    before.backward = per_area(pdf, at.position(), before);
}

}  // namespace

bool SubpathContext::evaluate(const PathVertex& v, const Vec3& outgoing, const Vec3& incident, BsdfValue& value) const {
    const Frame& frame = v.point.frame;
    if (!bsdf_evaluate(bsdf(v), shading(v), frame.to_local(outgoing), frame.to_local(incident), value)) return false;
    axes_to_world(v.point, value.f);
    return true;
}

float SubpathContext::pdf(const PathVertex& v, const Vec3& from, const Vec3& to) const {
    BsdfValue value;
    ShadingPoint point = shading(v);
    point.unpolarized_light = true;
    const Frame& frame = v.point.frame;
    return bsdf_evaluate(bsdf(v), point, frame.to_local(from), frame.to_local(to), value) ? value.pdf : 0.0f;
}

void trace_camera_path(const SubpathContext& context, const Sensor::CameraRay& camera, int most_vertices,
                       Sampler& sampler, std::vector<PathVertex>& path) {
    path.clear();
    PathVertex eye;
    eye.kind = PathVertex::Kind::camera;
    eye.point.position = camera.ray.origin;
    eye.point.geometric_normal = Vec3::Zero();
    eye.forward = 1;
    path.push_back(eye);

    Ray ray = camera.ray;
    Throughput throughput(camera.stokes_axis);
    int events = LightPathClassifier::eye;
    bool hero_only = false;
    float eta = 1;
    double pdf = 0;
    for (int depth = 0; static_cast<int>(path.size()) < most_vertices; ++depth) {
        sampler.seek(first_camera_draw + draws_per_vertex * static_cast<std::uint32_t>(depth));

        // Meet a surface, or infinity.
        PathVertex v;
        const bool found = meet(context.scene(), ray, v);
        if (!found) v = infinite_vertex(ray.direction);
        if (depth == 0) pdf = context.problem.sensor.importance(camera, found ? v.hit.t : INFINITY);
        v.forward = per_area(pdf, path.back().position(), v);
        v.throughput = throughput;
        v.events = events;
        v.hero_only = hero_only;
        path.push_back(v);
        if (!found || static_cast<int>(path.size()) >= most_vertices) return;

        // Draw the next direction.
        PathVertex& at = path.back();
        const float lobe = sampler.next();
        BsdfSample sample;
        const Vec3 outgoing = at.point.frame.to_local(at.to_previous);
        if (!bsdf_sample(context.bsdf(at), context.shading(at), outgoing, lobe, sampler.next2(), sample)) return;
        at.delta = sample.delta;
        at.event = sample.delta ? ScatteringEvent::specular : context.event(at, at.to_previous);
        axes_to_world(at.point, sample.weight);
        throughput.append(sample.weight, at.to_previous);
        if (sample.dispersed && !hero_only) {
            hero_only = true;
            throughput.keep_only_hero();
        }
        events = context.problem.classes.after(events, at.event);
        eta *= sample.eta;
        ray.direction = at.point.frame.to_world(sample.incident).normalized();
        ray.origin = at.point.origin(ray.direction);
        ray.t_max = INFINITY;
        pdf = sample.delta ? 1.0 : sample.pdf;
        set_backward(context, path[path.size() - 2], at, ray.direction);

        const float carried = largest(throughput.intensity());
        if (!(carried > 0)) return;
        if (depth + 1 >= context.rr_depth) {
            const float survival = std::min(carried * eta * eta, 0.95f);
            if (!(sampler.next() < survival)) return;
            throughput.scale(1 / survival);
        }
    }
}

void trace_light_path(const SubpathContext& context, int most_vertices, Sampler& sampler,
                      std::vector<PathVertex>& path) {
    path.clear();
    if (most_vertices < 2) return;
    sampler.seek(first_light_draw);
    EmittedRay emitted;
    const float choice = sampler.next();
    const Vec2 u_origin = sampler.next2();
    if (!context.emission.sample(context.w, choice, u_origin, sampler.next2(), emitted)) return;
    PathVertex lamp;
    lamp.kind = emitted.infinite ? PathVertex::Kind::infinity : PathVertex::Kind::light;
    lamp.point.position = emitted.position;
    lamp.point.geometric_normal = emitted.normal;
    lamp.point.uv = emitted.uv;
    lamp.emitter = emitted.emitter;
    lamp.forward = emitted.origin_pdf;
    path.push_back(lamp);

    Ray ray{emitted.position, emitted.direction, INFINITY, context.time};
    LightBeam beam = context.scene().lights.beam(emitted.emitter, emitted.power, emitted.direction);
    const float emitted_power = largest(emitted.power);
    bool hero_only = false;
    double pdf = emitted.ray_pdf;
    for (int depth = 0; static_cast<int>(path.size()) < most_vertices; ++depth) {
        sampler.seek(first_light_draw + draws_per_vertex * static_cast<std::uint32_t>(depth + 1));
        PathVertex v;
        if (!meet(context.scene(), ray, v)) return;
        v.forward = depth == 0 && emitted.infinite ? pdf * std::abs(v.point.geometric_normal.dot(ray.direction))
                                                   : per_area(pdf, path.back().position(), v);
        v.beam = beam;
        v.hero_only = hero_only;
        path.push_back(v);
        if (static_cast<int>(path.size()) >= most_vertices) return;

        // Draw where the light goes; the model draws for a path that runs backwards, so weigh by what light does.
        PathVertex& at = path.back();
        BsdfSample sample;
        const Vec3 incident = at.to_previous, local_incident = at.point.frame.to_local(incident);
        const float lobe = sampler.next();
        if (!bsdf_sample(context.bsdf(at), context.shading(at), local_incident, lobe, sampler.next2(), sample)) return;
        const Vec3 outgoing = at.point.frame.to_world(sample.incident).normalized();
        const float cos_in = std::abs(at.point.geometric_normal.dot(incident)),
                    cos_out = std::abs(at.point.geometric_normal.dot(outgoing));
        at.delta = sample.delta;
        at.event = sample.delta ? ScatteringEvent::specular : context.event(at, outgoing);
        if (!(cos_in > 0)) return;
        if (sample.delta) {
            ScatteringMatrix m = reversed(sample.weight);
            axes_to_world(at.point, m);
            // Flux is not scaled by the index squared as radiance is; shading normals scale it (Veach 1997, eq. 5.19).
            const float shading = std::abs(local_incident.z()) * cos_out / (cos_in * std::abs(sample.incident.z()));
            m.scale(splat(sqr(sample.eta) * shading * sample.adjoint));
            beam.scatter(m, outgoing);
        } else {
            BsdfValue value;
            if (!context.evaluate(at, outgoing, incident, value)) return;
            value.f.scale(splat(cos_out / (cos_in * sample.pdf)));
            beam.scatter(value.f, outgoing);
        }
        if (sample.dispersed && !hero_only) {
            hero_only = true;
            beam.stokes *= spread(Float4{4, 0, 0, 0});
        }
        ray.direction = outgoing;
        ray.origin = at.point.origin(outgoing);
        pdf = sample.delta ? 1.0 : sample.pdf;
        set_backward(context, path[path.size() - 2], at, outgoing);

        const float carried = largest(beam.intensity()) / emitted_power;
        if (!(carried > 0)) return;
        if (depth + 1 >= context.rr_depth) {
            const float survival = std::min(carried, 0.95f);
            if (!(sampler.next() < survival)) return;
            beam.stokes *= 1 / survival;
        }
    }
}

}  // namespace patina::render
