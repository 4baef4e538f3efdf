#include "patina/render/integrators/bidirectional.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/arriving_light.h"
#include "patina/render/integrators/subpath.h"

namespace patina::render {

namespace {

constexpr std::uint32_t first_join_draw = 2u << 20;

// One joined path from the lamp to the camera: both densities of each vertex, and where a join cannot be.
struct JoinedPath {
    struct Place {
        double from_light, from_camera;
        bool delta;
    };
    std::vector<Place> places;  // [0] is the lamp, the last the camera
    double direct_pdf = 0;      // of the lamp's point by light sampling from places[1]
    bool delta_light = false;
    bool blind = false;  // the camera cannot be joined

    // Share of the strategy with `s` vertices from the lamp: power heuristic over all strategies that could have made
    // this path. Strategy t has the density prod_{i<t} from_light prod_{i>=t} from_camera, light sampling (t = 1) its
    // own for the lamp.
    double share(int s) const {
        const int k = static_cast<int>(places.size()) - 1;
        double sum = 1, ratio = 1;
        const auto count = [&](int t) {
            // Vertices that coincide have no density from either side: no other strategy counts beyond them.
            const double density = ratio * lamp_factor(t) / lamp_factor(s);
            if (possible(t) && !std::isnan(density)) sum += density * density;
        };
        for (int t = s + 1; t <= k; ++t) {
            ratio *= places[t - 1].from_light / places[t - 1].from_camera;
            count(t);
        }
        ratio = 1;
        for (int t = s - 1; t >= 0; --t) {
            ratio *= places[t].from_camera / places[t].from_light;
            count(t);
        }
        return 1 / sum;
    }

  private:
    double lamp_factor(int t) const { return t == 1 ? direct_pdf / places[0].from_light : 1.0; }
    bool possible(int t) const {
        if (t == 0) return !delta_light;
        if (places.size() == 2) return false;  // lamps are not joined with the camera
        if (blind && t == static_cast<int>(places.size()) - 1) return false;
        return !places[t - 1].delta && !places[t].delta;
    }
};

class Joiner {
  public:
    Joiner(const SubpathContext& context, const std::vector<PathVertex>& camera, const std::vector<PathVertex>& light,
           bool weighted, PathRecord& record)
        : c_(context), camera_(camera), light_(light), weighted_(weighted), record_(record) {}

    // The camera path's vertex t - 1 shines.
    void hit_light(int t) {
        const PathVertex& v = camera_[t - 1];
        const int path_class = c_.problem.classes.path_class(v.events);
        const Lights& lights = c_.scene().lights;
        const auto add = [&](int emitter, Float4 radiance, float origin_pdf, float ray_pdf, float direct_pdf) {
            if (largest(radiance) <= 0) return;
            double share = 1;
            if (weighted_ && t > 2) share = share_of(0, t, v, origin_pdf, ray_pdf, direct_pdf, false);
            record_.add(arriving(v.throughput, lights, emitter, radiance * static_cast<float>(share), v.to_previous),
                        path_class);
        };
        if (v.kind == PathVertex::Kind::infinity) {
            for (int e : lights.environments()) {
                const Vec3 direction = -v.to_previous;
                float origin_pdf = 0, ray_pdf = 0, map_pdf = 0;
                c_.emission.environment_pdfs(e, direction, origin_pdf, ray_pdf);
                Float4 radiance;
                if (const auto* constant = std::get_if<ConstantEmitter>(&lights.all()[e])) {
                    radiance = constant->radiance.at(c_.w);
                } else {
                    const auto& map = std::get<EnvironmentEmitter>(lights.all()[e]);
                    radiance = map.radiance(c_.w, direction);
                    map_pdf = map.pdf(direction);
                }
                add(e, radiance, origin_pdf, ray_pdf,
                    lights.choice_probability(e, camera_[t - 2].position()) * map_pdf);
            }
        } else if (v.emitter >= 0) {
            float origin_pdf = 0, ray_pdf = 0;
            c_.emission.surface_pdfs(v.emitter, v.to_previous.dot(v.point.geometric_normal),
                                     lights.area_density(v.emitter, v.point.uv), origin_pdf, ray_pdf);
            const float direct =
                lights.surface_pdf(v.emitter, c_.scene().geometry, v.hit, v.point, camera_[t - 2].position());
            add(v.emitter, lights.surface_radiance(v.emitter, v.point, v.to_previous, c_.w), origin_pdf, ray_pdf,
                static_cast<float>(per_area(direct, camera_[t - 2].position(), v)));
        }
    }

    // Light sampling at the camera path's vertex t - 1.
    void join_lamp(int t, float choice, const Vec2& u) {
        const PathVertex& v = camera_[t - 1];
        const Scene& scene = c_.scene();
        LightSample light;
        BsdfValue value;
        if (!scene.lights.any_sampled() || c_.only_delta(v)) return;
        if (!scene.lights.sample(scene.geometry, v.position(), c_.w, choice, u, light)) return;
        if (!c_.evaluate(v, v.to_previous, light.direction, value)) return;
        const Ray shadow{v.point.origin(light.direction), light.direction, light.distance * (1 - 1e-4f), c_.time};
        if (scene.geometry.occluded(shadow)) return;

        double share = 1;
        if (weighted_) {
            lamp_ = PathVertex{};
            const bool infinite = !std::isfinite(light.distance);
            lamp_.kind = infinite ? PathVertex::Kind::infinity : PathVertex::Kind::light;
            lamp_.point.position =
                infinite ? Vec3(Vec3::Zero()) : Vec3(v.position() + light.distance * light.direction);
            lamp_.point.geometric_normal = light.normal;
            lamp_.emitter = light.emitter;
            lamp_.to_previous = -light.direction;
            float origin_pdf = 0, ray_pdf = 0;
            if (light.delta)
                c_.emission.delta_pdfs(light.emitter, origin_pdf, ray_pdf);
            else if (infinite)
                c_.emission.environment_pdfs(light.emitter, light.direction, origin_pdf, ray_pdf);
            else
                c_.emission.surface_pdfs(light.emitter, -light.direction.dot(light.normal), light.area_density,
                                         origin_pdf, ray_pdf);
            const double direct = light.delta ? light.pdf : per_area(light.pdf, v.position(), lamp_);
            share = share_of(1, t, lamp_, origin_pdf, ray_pdf, direct, light.delta);
        }
        const int events = c_.problem.classes.after(v.events, c_.event(v, v.to_previous));
        record_.add(
            arriving(v.throughput, scene.lights, light.emitter, light.radiance * static_cast<float>(share / light.pdf),
                     -light.direction, value.f, v.to_previous),
            c_.problem.classes.path_class(events));
    }

    // Joins the light path's vertex s - 1 with the camera path's vertex t - 1, two surfaces.
    void join(int s, int t) {
        const PathVertex &y = light_[s - 1], &z = camera_[t - 1];
        const Vec3 d = z.position() - y.position();
        const float distance2 = d.squaredNorm();
        if (!(distance2 > 0)) return;
        const Vec3 direction = d / std::sqrt(distance2);
        BsdfValue at_y, at_z;
        if (c_.only_delta(y) || c_.only_delta(z)) return;
        if (!c_.evaluate(y, direction, y.to_previous, at_y) || !c_.evaluate(z, z.to_previous, -direction, at_z)) return;
        const Ray shadow{y.point.origin(direction), direction, std::sqrt(distance2) * (1 - 1e-4f), c_.time};
        if (c_.scene().geometry.occluded(shadow)) return;

        // Light through y and z to the camera, in this order.
        LightBeam beam = y.beam;
        at_y.f.scale(splat(leaving_factor(y, direction) / distance2 * (y.hero_only && z.hero_only ? 0.25f : 1.0f)));
        beam.scatter(at_y.f, direction);
        beam.scatter(at_z.f, z.to_previous);
        const double share = weighted_ ? share_of(s, t, light_[0], 0, 0, direct_pdf(), delta_lamp()) : 1.0;
        beam.stokes *= static_cast<float>(share);
        int events = c_.problem.classes.after(z.events, c_.event(z, z.to_previous));
        events = light_events(events, y, direction, s);
        record_.add(z.throughput.of(beam.stokes, beam.x_axis, beam.direction), c_.problem.classes.path_class(events));
    }

    // Joins the light path's vertex s - 1 with a point of the lens.
    void join_camera(int s, const Vec2& lens) {
        const PathVertex& y = light_[s - 1];
        Sensor::Sight sight;
        BsdfValue at_y;
        if (c_.only_delta(y) || !c_.problem.sensor.see(y.position(), lens, sight)) return;
        const Vec3 direction = -sight.direction;
        if (!c_.evaluate(y, direction, y.to_previous, at_y)) return;
        const Ray shadow{y.point.origin(direction), direction, sight.distance * (1 - 1e-4f), c_.time};
        if (c_.scene().geometry.occluded(shadow)) return;
        LightBeam beam = y.beam;
        at_y.f.scale(splat(leaving_factor(y, direction) * sight.importance / sqr(sight.distance)));
        beam.scatter(at_y.f, direction);
        double share = 1;
        if (weighted_) {
            eye_ = PathVertex{};
            eye_.kind = PathVertex::Kind::camera;
            eye_.point.position = sight.from;
            eye_.point.geometric_normal = Vec3::Zero();
            eye_.forward = 1;
            eye_importance_ = sight.importance;
            share = share_of(s, 1, light_[0], 0, 0, direct_pdf(), delta_lamp());
        }
        const int events = light_events(LightPathClassifier::eye, y, direction, s);
        const Throughput camera(sight.stokes_axis);
        record_.add_splat({sight.film, c_.problem.classes.path_class(events),
                           camera.of(beam.stokes, beam.x_axis, beam.direction) * static_cast<float>(share), c_.w});
    }

    // The light path's lamp, as light sampling from the path's first surface would find it.
    void find_direct_pdf() {
        direct_pdf_ = 0;
        if (light_.size() < 2) return;
        const Lights& lights = c_.scene().lights;
        const PathVertex &lamp = light_[0], &first = light_[1];
        const float choice = lights.choice_probability(lamp.emitter, first.position());
        const Emitter& emitter = lights.all()[lamp.emitter];
        if (const auto* map = std::get_if<EnvironmentEmitter>(&emitter)) {
            direct_pdf_ = choice * map->pdf(first.to_previous);
        } else if (const auto* area = std::get_if<AreaEmitter>(&emitter)) {
            Hit hit;
            hit.shape = area->shape;
            const Shape& shape = c_.scene().geometry.shapes[area->shape];
            hit.triangle = shape.is_mesh;
            hit.primitive = shape.is_mesh ? 0 : shape.first;
            SurfacePoint at = lamp.point;
            const float pdf = c_.scene().geometry.shape_pdf(hit, at, first.position());
            direct_pdf_ =
                choice * lights.area_density(lamp.emitter, lamp.point.uv) * per_area(pdf, first.position(), lamp);
        } else if (!std::holds_alternative<ConstantEmitter>(emitter)) {
            direct_pdf_ = choice;
        }
    }

  private:
    double direct_pdf() const { return direct_pdf_; }
    bool delta_lamp() const { return c_.scene().lights.is_delta(light_[0].emitter); }

    // Turns BSDF times the cosine towards the lamp into flux per solid angle that leaves (Veach 1997, eq. 5.19).
    static float leaving_factor(const PathVertex& y, const Vec3& direction) {
        const float cos_in = std::abs(y.point.geometric_normal.dot(y.to_previous));
        return cos_in > 0 ? std::abs(y.point.geometric_normal.dot(direction)) / cos_in : 0.0f;
    }

    int light_events(int events, const PathVertex& y, const Vec3& direction, int s) const {
        const LightPathClassifier& classes = c_.problem.classes;
        events = classes.after(events, c_.event(y, direction));
        for (int i = s - 2; i >= 1; --i) events = classes.after(events, light_[i].event);
        return events;
    }

    // Share of the strategy that joined s vertices from the lamp with t of the camera's. With s < 2 the lamp and its
    // densities are given; otherwise they are the light path's.
    double share_of(int s, int t, const PathVertex& lamp, double origin_pdf, double ray_pdf, double direct,
                    bool delta_light) {
        JoinedPath& path = path_;
        path.direct_pdf = direct;
        path.delta_light = delta_light;
        path.blind = c_.problem.sensor.blind();
        path.places.clear();
        const auto vertex = [&](int i) -> const PathVertex& {
            if (i < s) return s == 1 ? lamp : light_[i];
            const int from_camera = s + t - 1 - i;
            return t == 1 && from_camera == 0 ? eye_ : camera_[from_camera];
        };
        const int count = s + t;
        for (int i = 0; i < count; ++i) {
            const PathVertex& v = vertex(i);
            const bool joined = i == s - 1 || i == s;
            if (i < s)
                path.places.push_back({v.forward, v.backward, !joined && v.delta});
            else
                path.places.push_back({v.backward, v.forward, !joined && v.delta});
        }
        // The ends of the join, and the vertices next to them, are found from the other side by way of it.
        if (s <= 1) {
            path.places[0].from_light = origin_pdf;
            const PathVertex &l = vertex(0), &first = vertex(1);
            const Vec3 to_lamp = l.kind == PathVertex::Kind::infinity
                                     ? Vec3(-l.to_previous)
                                     : Vec3((l.position() - first.position()).normalized());
            path.places[1].from_light = l.kind == PathVertex::Kind::infinity && first.kind == PathVertex::Kind::surface
                                            ? ray_pdf * std::abs(first.point.geometric_normal.dot(to_lamp))
                                            : per_area(ray_pdf, l.position(), first);
            if (s == 1) {
                path.places[0].from_camera =
                    delta_light ? 0.0 : per_area(c_.pdf(first, first.to_previous, to_lamp), first.position(), l);
            }
            if (count > 2) {
                const bool passes_delta = s == 0 && first.delta;
                const float pdf = passes_delta ? 1.0f : c_.pdf(first, to_lamp, first.to_previous);
                path.places[2].from_light = per_area(pdf, first.position(), vertex(2));
            }
        } else {
            const PathVertex &y = vertex(s - 1), &z = vertex(s);
            const Vec3 direction = (z.position() - y.position()).normalized();
            // The camera finds y from z, and then the vertex before y.
            const double z_pdf = t == 1 ? eye_importance_ : c_.pdf(z, z.to_previous, -direction);
            path.places[s - 1].from_camera = per_area(z_pdf, z.position(), y);
            path.places[s - 2].from_camera =
                delta_light && s == 2 ? 0.0
                                      : per_area(c_.pdf(y, direction, y.to_previous), y.position(), vertex(s - 2));
            // The lamp finds z from y, and then the vertex after z.
            path.places[s].from_light = per_area(c_.pdf(y, y.to_previous, direction), y.position(), z);
            if (t > 1)
                path.places[s + 1].from_light =
                    per_area(c_.pdf(z, -direction, z.to_previous), z.position(), vertex(s + 1));
        }
        return path.share(s);
    }

    const SubpathContext& c_;
    const std::vector<PathVertex>&camera_, &light_;
    bool weighted_;
    PathRecord& record_;
    JoinedPath path_;
    PathVertex lamp_, eye_;
    double direct_pdf_ = 0;
    float eye_importance_ = 0;
};

}  // namespace

void BidirectionalIntegrator::prepare(const TransportProblem& problem, const JobControl&) {
    if (settings_.light_only && problem.sensor.blind())
        throw input_error(problem.scene.sensor_node->where,
                          fmt::format("no light path meets a {}", problem.scene.sensor_node->type),
                          "it looks along single rays", "use path or bidirectional");
    emission_.emplace(problem.scene.lights, problem.scene.geometry);
}

void BidirectionalIntegrator::trace(const TransportProblem& problem, const Sensor::CameraRay& camera,
                                    const Wavelengths& wavelengths, Sampler& sampler, PathRecord& record) const {
    const int depth = settings_.max_depth < 0 ? std::numeric_limits<int>::max() / 2 : settings_.max_depth;
    if (depth == 0) return;
    const SubpathContext context{problem, wavelengths, *emission_, settings_.rr_depth, camera.ray.time};
    std::vector<PathVertex> camera_path, light_path;
    camera_path.reserve(8);
    light_path.reserve(8);
    trace_camera_path(context, camera, settings_.light_only ? 2 : depth + 1, sampler, camera_path);
    trace_light_path(context, depth, sampler, light_path);
    record.hit = camera_path.size() > 1 && camera_path[1].kind == PathVertex::Kind::surface;

    Joiner joiner(context, camera_path, light_path, !settings_.light_only, record);
    joiner.find_direct_pdf();
    const int cameras = static_cast<int>(camera_path.size()), lights = static_cast<int>(light_path.size());
    for (int t = 2; t <= cameras; ++t) {
        // What the camera path meets by itself, then by light sampling, then by joining.
        if (t > 2 || !settings_.hide_emitters) joiner.hit_light(t);
        if (settings_.light_only || camera_path[t - 1].kind != PathVertex::Kind::surface) break;
        sampler.seek(first_join_draw + 4 * static_cast<std::uint32_t>(t));
        const float choice = sampler.next();
        if (t <= depth) joiner.join_lamp(t, choice, sampler.next2());
        for (int s = 2; s <= lights && s + t - 1 <= depth; ++s) joiner.join(s, t);
    }
    for (int s = 2; s <= lights && s <= depth; ++s) {
        sampler.seek(first_join_draw + (1u << 18) + 4 * static_cast<std::uint32_t>(s));
        const Vec2 lens = problem.sensor.uses_lens() ? sampler.next2() : Vec2(0.5f, 0.5f);
        joiner.join_camera(s, lens);
    }
}

}  // namespace patina::render
