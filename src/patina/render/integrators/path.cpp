#include "patina/render/integrators/path.h"

#include "patina/render/arriving_light.h"
#include "patina/render/mueller_packet.h"
#include "patina/render/scene.h"

namespace patina::render {

namespace {

// Random draws that belong to the camera, and that one vertex may take.
constexpr std::uint32_t first_draw = 8, draws_per_vertex = 8;

// One path being traced: where it is, what it carries, and how the last step was drawn.
class PathState {
  public:
    PathState(const TransportProblem& problem, const Sensor::CameraRay& camera, const Wavelengths& wavelengths,
              Sampler& sampler, PathRecord& record)
        : scene_(problem.scene),
          classes_(problem.classes),
          w_(wavelengths),
          sampler_(sampler),
          record_(record),
          ray_(camera.ray),
          throughput_(camera.stokes_axis) {}

    bool find_surface() {
        Hit hit;
        if (!scene_.geometry.intersect(ray_, hit)) return false;
        hit_ = hit;
        point_ = scene_.geometry.surface(ray_, hit);
        return true;
    }

    // Light of the environments that the last direction ran into.
    void add_environment() {
        scene_.lights.for_each_environment(ray_.direction, w_, [&](Float4 radiance, float light_pdf, int emitter) {
            add(arriving(throughput_, scene_.lights, emitter, radiance * share_of_scattering(light_pdf),
                         -ray_.direction),
                events_);
        });
    }

    // Light of the surface itself.
    void add_emission() {
        const int emitter = scene_.geometry.shapes[hit_.shape].emitter;
        if (emitter < 0) return;
        const Float4 radiance = scene_.lights.surface_radiance(emitter, point_, -ray_.direction, w_);
        if (largest(radiance) <= 0) return;
        const float light_pdf =
            last_delta_ ? 0.0f : scene_.lights.surface_pdf(emitter, scene_.geometry, hit_, point_, last_position_);
        add(arriving(throughput_, scene_.lights, emitter, radiance * share_of_scattering(light_pdf), -ray_.direction),
            events_);
    }

    // Light of a lamp drawn at random, scattered here.
    void add_direct_light() {
        ShadingPoint shading = shading_point();
        shading.unpolarized_light = !scene_.lights.any_polarized();
        if (!scene_.lights.any_sampled() || bsdf_is_delta(bsdf(), shading)) return;
        LightSample light;
        const float choice = sampler_.next();
        if (!scene_.lights.sample(scene_.geometry, point_.position, w_, choice, sampler_.next2(), light)) return;
        BsdfValue value;
        const Vec3 outgoing = point_.frame.to_local(-ray_.direction), incident = point_.frame.to_local(light.direction);
        if (!bsdf_evaluate(bsdf(), shading, outgoing, incident, value)) return;
        if (!visible(light)) return;
        const float share = light.delta ? 1.0f : power_heuristic(light.pdf, value.pdf);
        axes_to_world(value.f);
        const int events = classes_.after(events_, continuous_event(bsdf(), shading, outgoing));
        add(arriving(throughput_, scene_.lights, light.emitter, light.radiance * (share / light.pdf), -light.direction,
                     value.f, -ray_.direction),
            events);
    }

    // Draws the next direction; false: the path ends.
    bool scatter() {
        BsdfSample sample;
        const float lobe = sampler_.next();
        const Vec3 outgoing = point_.frame.to_local(-ray_.direction);
        const ShadingPoint shading = shading_point();
        if (!bsdf_sample(bsdf(), shading, outgoing, lobe, sampler_.next2(), sample)) return false;
        events_ = classes_.after(
            events_, sample.delta ? ScatteringEvent::specular : continuous_event(bsdf(), shading, outgoing));
        axes_to_world(sample.weight);
        throughput_.append(sample.weight, -ray_.direction);
        if (sample.dispersed && !hero_only_) {
            hero_only_ = true;
            throughput_.keep_only_hero();
        }
        eta_ *= sample.eta;
        last_position_ = point_.position;
        last_pdf_ = sample.pdf;
        last_delta_ = sample.delta;
        ray_.direction = point_.frame.to_world(sample.incident).normalized();
        ray_.origin = point_.origin(ray_.direction);
        ray_.t_max = INFINITY;
        return true;
    }

    // Ends paths that carry little; false: ended. Radiance inside a dense medium is larger without being worth more.
    bool survives_roulette() {
        const float carried = largest(throughput_.intensity()) * eta_ * eta_;
        const float survival = std::min(carried, 0.95f);
        if (!(sampler_.next() < survival)) return false;
        throughput_.scale(1 / survival);
        return true;
    }
    bool carries_light() const { return largest(throughput_.intensity()) > 0; }

  private:
    const Bsdf& bsdf() const { return scene_.bsdfs[scene_.geometry.shapes[hit_.shape].bsdf]; }
    ShadingPoint shading_point() const { return {&w_, point_.uv, scene_.bsdfs.data()}; }
    void add(const StokesPacket& stokes, int events) { record_.add(stokes, classes_.path_class(events)); }

    float share_of_scattering(float light_pdf) const {
        return last_delta_ || light_pdf <= 0 ? 1.0f : power_heuristic(last_pdf_, light_pdf);
    }
    bool visible(const LightSample& light) const {
        // Stop short of the lamp itself; a share of the distance covers the rounding of its position.
        Ray shadow{point_.origin(light.direction), light.direction, light.distance * (1 - 1e-4f), ray_.time};
        return !scene_.geometry.occluded(shadow);
    }
    void axes_to_world(ScatteringMatrix& m) const {
        if (m.form == ScatteringMatrix::Form::depolarizing) return;
        m.x_in = point_.frame.to_world(m.x_in);
        m.x_out = point_.frame.to_world(m.x_out);
    }

    const Scene& scene_;
    const LightPathClassifier& classes_;
    const Wavelengths& w_;
    Sampler& sampler_;
    PathRecord& record_;
    Ray ray_;
    Throughput throughput_;
    Hit hit_;
    SurfacePoint point_;
    int events_ = LightPathClassifier::eye;  // what the path has met, as the classifier's state
    Vec3 last_position_ = Vec3::Zero();
    float last_pdf_ = 0, eta_ = 1;
    bool last_delta_ = true, hero_only_ = false;
};

}  // namespace

void PathIntegrator::trace(const TransportProblem& problem, const Sensor::CameraRay& camera,
                           const Wavelengths& wavelengths, Sampler& sampler, PathRecord& record) const {
    PathState path(problem, camera, wavelengths, sampler, record);
    for (int depth = 0; settings_.max_depth < 0 || depth < settings_.max_depth; ++depth) {
        sampler.seek(first_draw + draws_per_vertex * static_cast<std::uint32_t>(depth));
        const bool show = depth > 0 || !settings_.hide_emitters;

        // Meet a surface, or leave the scene.
        const bool found = path.find_surface();
        if (depth == 0) record.hit = found;
        if (!found) {
            if (show) path.add_environment();
            break;
        }
        if (show) path.add_emission();
        if (settings_.max_depth >= 0 && depth + 1 >= settings_.max_depth) break;

        // Gather direct light, and go on.
        path.add_direct_light();
        if (!path.scatter() || !path.carries_light()) break;
        if (depth + 1 >= settings_.rr_depth && !path.survives_roulette()) break;
    }
}

}  // namespace patina::render
