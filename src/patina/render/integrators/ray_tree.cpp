#include "patina/render/integrators/ray_tree.h"

#include "patina/render/arriving_light.h"
#include "patina/render/mueller_packet.h"
#include "patina/render/scene.h"

namespace patina::render {

namespace {

constexpr std::uint32_t first_draw = 8;  // after the camera's
constexpr int forks = 5;                 // interfaces at which both rays are followed; further on one is drawn
constexpr float last_unit_float = 0x1.fffffep-1f;

// A ray on its way and what it carries; how it was drawn, for sharing what it hits with light sampling.
struct Branch {
    Ray ray;
    Throughput throughput;
    int depth = 0;
    int events = LightPathClassifier::eye;
    bool shows_light = true, goes_on = true, hero_only = false;
    Vec3 from = Vec3::Zero();
    float density = 0;  // rays drawn times density; 0: a delta function
    float eta = 1;
};

class Tree {
  public:
    Tree(const RayTreeIntegrator::Settings& settings, const TransportProblem& problem, const Wavelengths& wavelengths,
         Sampler& sampler, PathRecord& record)
        : settings_(settings),
          scene_(problem.scene),
          classes_(problem.classes),
          w_(wavelengths),
          sampler_(sampler),
          record_(record) {}

    void follow(Branch& branch) {
        Hit hit;
        const bool found = scene_.geometry.intersect(branch.ray, hit);
        if (branch.depth == 0) record_.hit = found;
        if (!found) {
            if (branch.shows_light) add_environment(branch);
            return;
        }
        const SurfacePoint point = scene_.geometry.surface(branch.ray, hit);
        if (branch.shows_light) add_emission(branch, hit, point);
        if (!branch.goes_on || (settings_.max_depth >= 0 && branch.depth + 1 >= settings_.max_depth)) return;
        if (branch.depth >= settings_.rr_depth && !survives_roulette(branch)) return;
        add_direct_light(branch, point);
        scatter(branch, point);
    }

  private:
    int light_samples(const Branch& branch) const { return branch.depth == 0 ? settings_.light_samples : 1; }
    int lobe_samples(const Branch& branch) const { return branch.depth == 0 ? settings_.lobe_samples : 1; }
    const Bsdf& bsdf(const SurfacePoint& point) const { return scene_.bsdfs[scene_.geometry.shapes[point.shape].bsdf]; }
    ShadingPoint shading_point(const SurfacePoint& point) const { return {&w_, point.uv, scene_.bsdfs.data()}; }
    void add(const StokesPacket& stokes, int events) { record_.add(stokes, classes_.path_class(events)); }
    static float share(const Branch& branch, float light_density) {
        return branch.density > 0 && light_density > 0 ? power_heuristic(branch.density, light_density) : 1.0f;
    }

    void add_environment(const Branch& b) {
        // The surface that sent the ray looked for light with as many samples as its own depth has.
        const int samples = b.depth == 1 ? settings_.light_samples : 1;
        scene_.lights.for_each_environment(b.ray.direction, w_, [&](Float4 radiance, float light_pdf, int emitter) {
            add(arriving(b.throughput, scene_.lights, emitter, radiance * share(b, samples * light_pdf),
                         -b.ray.direction),
                b.events);
        });
    }
    void add_emission(const Branch& b, const Hit& hit, const SurfacePoint& point) {
        const int emitter = scene_.geometry.shapes[point.shape].emitter;
        if (emitter < 0) return;
        const Float4 radiance = scene_.lights.surface_radiance(emitter, point, -b.ray.direction, w_);
        if (largest(radiance) <= 0) return;
        const int samples = b.depth == 1 ? settings_.light_samples : 1;
        const float light_pdf =
            b.density > 0 ? scene_.lights.surface_pdf(emitter, scene_.geometry, hit, point, b.from) : 0.0f;
        add(arriving(b.throughput, scene_.lights, emitter, radiance * share(b, samples * light_pdf), -b.ray.direction),
            b.events);
    }

    void add_direct_light(const Branch& b, const SurfacePoint& point) {
        ShadingPoint shading = shading_point(point);
        shading.unpolarized_light = !scene_.lights.any_polarized();
        if (!scene_.lights.any_sampled() || bsdf_is_delta(bsdf(point), shading)) return;
        const Vec3 outgoing = point.frame.to_local(-b.ray.direction);
        const int events = classes_.after(b.events, continuous_event(bsdf(point), shading, outgoing));
        const int samples = light_samples(b);
        for (int i = 0; i < samples; ++i) {
            LightSample light;
            BsdfValue value;
            const float choice = std::min((i + sampler_.next()) / samples, last_unit_float);
            if (!scene_.lights.sample(scene_.geometry, point.position, w_, choice, sampler_.next2(), light)) continue;
            if (!bsdf_evaluate(bsdf(point), shading, outgoing, point.frame.to_local(light.direction), value)) continue;
            const Ray shadow{point.origin(light.direction), light.direction, light.distance * (1 - 1e-4f), b.ray.time};
            if (scene_.geometry.occluded(shadow)) continue;
            const float part = light.delta ? 1.0f : power_heuristic(samples * light.pdf, lobe_samples(b) * value.pdf);
            axes_to_world(point, value.f);
            add(arriving(b.throughput, scene_.lights, light.emitter, light.radiance * (part / (samples * light.pdf)),
                         -light.direction, value.f, -b.ray.direction),
                events);
        }
    }

    void scatter(const Branch& b, const SurfacePoint& point) {
        const ShadingPoint shading = shading_point(point);
        const Vec3 outgoing = point.frame.to_local(-b.ray.direction);
        const bool only_delta = bsdf_is_delta(bsdf(point), shading);
        if (only_delta && !settings_.follow_specular) return;
        if (only_delta && b.depth < forks && fork(b, point, shading, outgoing)) return;
        const int samples = only_delta ? 1 : lobe_samples(b);
        for (int i = 0; i < samples; ++i) {
            BsdfSample sample;
            const float lobe = std::min((i + sampler_.next()) / samples, last_unit_float);
            if (!bsdf_sample(bsdf(point), shading, outgoing, lobe, sampler_.next2(), sample)) continue;
            branch_off(b, point, shading, outgoing, sample, samples);
        }
    }

    // Follows reflection and refraction both; false: this is no pair of delta functions.
    bool fork(const Branch& b, const SurfacePoint& point, const ShadingPoint& shading, const Vec3& outgoing) {
        BsdfSample pair[2];
        const Vec2 u2(0.5f, 0.5f);
        if (!bsdf_sample(bsdf(point), shading, outgoing, 0.0f, u2, pair[0]) ||
            !bsdf_sample(bsdf(point), shading, outgoing, last_unit_float, u2, pair[1]))
            return false;
        if (!pair[0].delta || !pair[1].delta || std::abs(pair[0].pdf + pair[1].pdf - 1) > 1e-5f) return false;
        for (BsdfSample& sample : pair) {
            sample.weight.scale(splat(sample.pdf));
            branch_off(b, point, shading, outgoing, sample, 1);
        }
        return true;
    }

    void branch_off(const Branch& b, const SurfacePoint& point, const ShadingPoint& shading, const Vec3& outgoing,
                    BsdfSample& sample, int samples) {
        const ScatteringEvent event =
            sample.delta ? ScatteringEvent::specular : continuous_event(bsdf(point), shading, outgoing);
        if (sample.delta && !settings_.follow_specular) return;
        Branch next = b;
        axes_to_world(point, sample.weight);
        next.throughput.append(sample.weight, -b.ray.direction);
        next.throughput.scale(1.0f / samples);
        if (sample.dispersed && !b.hero_only) {
            next.hero_only = true;
            next.throughput.keep_only_hero();
        }
        if (!(largest(next.throughput.intensity()) > 0)) return;
        next.depth = b.depth + 1;
        next.events = classes_.after(b.events, event);
        next.goes_on = sample.delta || (settings_.follow_glossy && event == ScatteringEvent::glossy);
        next.shows_light = !sample.delta || !settings_.hide_emitters || has_lobe(b);
        next.from = point.position;
        next.density = sample.delta ? 0.0f : samples * sample.pdf;
        next.eta = b.eta * sample.eta;
        next.ray.direction = point.frame.to_world(sample.incident).normalized();
        next.ray.origin = point.origin(next.ray.direction);
        next.ray.t_max = INFINITY;
        follow(next);
    }

    // Has the branch met a lobe, after which lamps belong to every grammar here?
    static bool has_lobe(const Branch& b) { return b.depth > 0 && b.shows_light; }

    bool survives_roulette(Branch& b) {
        const float survival = std::min(largest(b.throughput.intensity()) * b.eta * b.eta, 0.95f);
        if (!(sampler_.next() < survival)) return false;
        b.throughput.scale(1 / survival);
        return true;
    }
    static void axes_to_world(const SurfacePoint& point, ScatteringMatrix& m) {
        if (m.form == ScatteringMatrix::Form::depolarizing) return;
        m.x_in = point.frame.to_world(m.x_in);
        m.x_out = point.frame.to_world(m.x_out);
    }

    const RayTreeIntegrator::Settings& settings_;
    const Scene& scene_;
    const LightPathClassifier& classes_;
    const Wavelengths& w_;
    Sampler& sampler_;
    PathRecord& record_;
};

}  // namespace

void RayTreeIntegrator::trace(const TransportProblem& problem, const Sensor::CameraRay& camera,
                              const Wavelengths& wavelengths, Sampler& sampler, PathRecord& record) const {
    if (settings_.max_depth == 0) return;
    sampler.seek(first_draw);
    Branch root{camera.ray, Throughput(camera.stokes_axis)};
    root.shows_light = !settings_.hide_emitters;
    Tree(settings_, problem, wavelengths, sampler, record).follow(root);
}

}  // namespace patina::render
