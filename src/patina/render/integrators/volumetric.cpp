#include "patina/render/integrators/volumetric.h"

#include "patina/render/arriving_light.h"
#include "patina/render/integrators/subsurface_probe.h"
#include "patina/render/mueller_packet.h"
#include "patina/render/scene.h"

namespace patina::render {

namespace {

// Random draws that belong to the camera, and that one step may take.
constexpr std::uint32_t first_draw = 8, draws_per_step = 12;

// Paths in a medium that absorbs little have hundreds of events, each of which carries on nearly all of the light: an
// end as likely as at surfaces would leave few of them with a large weight.
constexpr float likely_survival_at_surface = 0.95f, likely_survival_in_medium = 0.999f;

// One of the wavelengths in proportion to their shares; u becomes uniform again.
int choose_lane(Float4 share, float& u) {
    float below = 0;
    for (int lane = 0; lane + 1 < wavelengths_per_path; ++lane) {
        if (u < below + share[lane]) {
            u = std::min((u - below) / share[lane], 0x1.fffffep-1f);
            return lane;
        }
        below += share[lane];
    }
    const int last = wavelengths_per_path - 1;
    u = std::clamp((u - below) / std::max(share[last], 1e-20f), 0.0f, 0x1.fffffep-1f);
    return last;
}

// A path being traced: where it is, what it carries, and how the last step was drawn.
class VolumePath {
  public:
    VolumePath(const TransportProblem& problem, const Sensor::CameraRay& camera, const Wavelengths& wavelengths,
               Sampler& sampler, PathRecord& record)
        : scene_(problem.scene),
          classes_(problem.classes),
          w_(wavelengths),
          sampler_(sampler),
          record_(record),
          ray_(camera.ray),
          throughput_(camera.stokes_axis),
          medium_(problem.scene.camera_medium) {}

    bool find_surface() {
        Hit hit;
        hit.t = INFINITY;
        found_ = scene_.geometry.intersect(ray_, hit);
        hit_ = hit;
        if (found_) point_ = scene_.geometry.surface(ray_, hit);
        return found_;
    }
    bool at_null() const { return is_null(hit_.shape); }

    // Does a particle come before the surface? Weights the path by the flight either way.
    bool meets_particle() {
        if (medium_ == vacuum) return false;
        const Medium& medium = scene_.media[medium_];
        const Float4 extinction = medium.extinction.at(w_), share = shares();
        const float distance = found_ ? hit_.t : INFINITY;

        // Draw the flight at one wavelength.
        float u = sampler_.next();
        const float chosen = extinction[choose_lane(share, u)];
        const float flight = chosen > 0 ? -std::log1p(-u) / chosen : INFINITY;
        const bool meets = flight < distance;

        // Weight it by its density over all of them.
        const Float4 passed = Medium::transmittance(extinction, meets ? flight : distance);
        if (meets) {
            throughput_.scale(passed * extinction * medium.albedo.at(w_) / sum(share * extinction * passed));
            position_ = ray_.origin + flight * ray_.direction;
        } else {
            const float chance = sum(share * passed);
            throughput_.scale(passed / chance);
            if (counts_passing_) last_pdf_ *= chance;
        }
        return meets;
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

    // Goes on behind a surface that is not there.
    void cross_boundary() {
        medium_ = behind(point_, ray_.direction, medium_);
        ray_.origin = point_.origin(ray_.direction);
    }

    // Light of a lamp drawn at random, scattered by the surface.
    void add_direct_light_at_surface() {
        ShadingPoint shading = shading_point();
        shading.unpolarized_light = !scene_.lights.any_polarized();
        if (!scene_.lights.any_sampled() || bsdf_is_delta(bsdf(), shading)) return;
        LightSample light;
        const float choice = sampler_.next();
        if (!scene_.lights.sample(scene_.geometry, point_.position, w_, choice, sampler_.next2(), light)) return;
        BsdfValue value;
        const Vec3 outgoing = point_.frame.to_local(-ray_.direction), incident = point_.frame.to_local(light.direction);
        if (!bsdf_evaluate(bsdf(), shading, outgoing, incident, value)) return;
        const Float4 passed = transmittance(light, point_.origin(light.direction), side_medium(light.direction));
        if (largest(passed) <= 0) return;
        const float share = light.delta ? 1.0f : power_heuristic(light.pdf, value.pdf);
        axes_to_world(value.f);
        const int events = classes_.after(events_, continuous_event(bsdf(), shading, outgoing));
        add(arriving(throughput_, scene_.lights, light.emitter, passed * light.radiance * (share / light.pdf),
                     -light.direction, value.f, -ray_.direction),
            events);
    }

    // The same, scattered by a particle.
    void add_direct_light_at_particle() {
        if (!scene_.lights.any_sampled()) return;
        LightSample light;
        const float choice = sampler_.next();
        if (!scene_.lights.sample(scene_.geometry, position_, w_, choice, sampler_.next2(), light)) return;
        const Float4 passed = transmittance(light, position_, medium_);
        if (largest(passed) <= 0) return;
        const float cosine = std::clamp(light.direction.dot(ray_.direction), -1.0f, 1.0f);
        const PhaseElements f = phase_elements(scene_.media[medium_].phase, w_, cosine);
        ScatteringMatrix matrix = phase_matrix(f, -light.direction, -ray_.direction);
        matrix.scale(splat(0.25f * inv_pi_f));
        float share = 1;
        if (!light.delta) {
            // What chance has scattering to find the lamp: the angle's, and to pass what is on the way.
            const float angle_pdf = 0.25f * inv_pi_f * sum(shares() * f.a1);
            const Float4 carried = stokes_row(throughput_.of_unpolarized(splat(1), matrix, -ray_.direction), 0);
            const float total = sum(carried);
            if (!(total > 0)) return;
            share = power_heuristic(light.pdf, angle_pdf * sum(carried * passed) / total);
        }
        const int events = classes_.after(events_, ScatteringEvent::volume);
        add(arriving(throughput_, scene_.lights, light.emitter, passed * light.radiance * (share / light.pdf),
                     -light.direction, matrix, -ray_.direction),
            events);
    }

    // Draws the next direction at the surface; false: the path ends.
    bool scatter_at_surface() {
        BsdfSample sample;
        const float lobe = sampler_.next();
        const Vec3 outgoing = point_.frame.to_local(-ray_.direction);
        const ShadingPoint shading = shading_point();
        if (!bsdf_sample(bsdf(), shading, outgoing, lobe, sampler_.next2(), sample)) return false;
        follow(sample, sample.delta ? ScatteringEvent::specular : continuous_event(bsdf(), shading, outgoing));
        return true;
    }

    // Translucent matter below the surface, or null.
    const Dipole* translucent() const { return std::get_if<Dipole>(&bsdf().model); }

    // Reflects the path, or takes it to where light enters the matter: gathers what a lamp sends there, and draws the
    // next direction. False: the path ends.
    bool scatter_in_matter(const Dipole& matter) {
        const Vec3 outgoing = point_.frame.to_local(-ray_.direction);
        if (outgoing.z() <= 0) return false;
        const float lobe = sampler_.next(), body = matter.body_share(w_, outgoing);
        if (lobe < 1 - body) {
            BsdfSample sample;
            if (!matter.sample(shading_point(), outgoing, lobe, Vec2::Zero(), sample)) return false;
            follow(sample, ScatteringEvent::specular);
            return true;
        }

        // Leave by refraction, from where the profile says.
        ScatteringMatrix matrix;
        matter.leave(w_, outgoing, matrix);
        matrix.scale(splat(1 / body));
        axes_to_world(matrix);
        throughput_.append(matrix, -ray_.direction);
        SubsurfaceEntry entry;
        const float u_axis = sampler_.next(), u_hit = sampler_.next();
        if (!sample_subsurface(scene_.geometry, matter.profile(w_), point_, shares(), u_axis, sampler_.next2(), u_hit,
                               entry, ray_.time))
            return false;
        point_ = entry.point;
        ray_.direction = -point_.geometric_normal;
        matrix.set_depolarizing(entry.weight);
        throughput_.append(matrix, -ray_.direction);
        events_ = classes_.after(events_, ScatteringEvent::diffuse);

        // Enter: from a lamp, and from anywhere.
        add_direct_light_below(matter);
        BsdfSample sample;
        sample.incident = cosine_hemisphere(sampler_.next2());
        if (!(sample.incident.z() > 0)) return false;
        sample.pdf = sample.incident.z() * inv_pi_f;
        matter.enter(w_, sample.incident, sample.weight);
        sample.weight.scale(splat(1 / sample.pdf));
        go_on(sample);
        return true;
    }

    // The same at the particle.
    void scatter_at_particle() {
        const Phase& phase = scene_.media[medium_].phase;
        const Float4 share = shares();
        Vec2 u = sampler_.next2();
        const int lane = choose_lane(share, u.x());
        const float cosine = phase_sample_cosine(phase, w_, lane, u.x());
        const float sine = safe_sqrt(1 - cosine * cosine), azimuth = 2 * pi_f * u.y();
        const Vec3 direction =
            Frame(ray_.direction).to_world({sine * std::cos(azimuth), sine * std::sin(azimuth), cosine}).normalized();
        const PhaseElements f = phase_elements(phase, w_, cosine);
        const float density = sum(share * f.a1);
        ScatteringMatrix matrix = phase_matrix(f, -direction, -ray_.direction);
        matrix.scale(splat(1 / density));
        throughput_.append(matrix, -ray_.direction);
        events_ = classes_.after(events_, ScatteringEvent::volume);
        last_position_ = position_;
        last_pdf_ = 0.25f * inv_pi_f * density;
        last_delta_ = false;
        counts_passing_ = true;
        ray_ = {position_, direction, INFINITY, ray_.time};
    }

    // Ends paths that carry little; false: ended. Radiance inside a dense medium is larger without being worth more.
    bool survives_roulette(float most) {
        const float survival = std::min(largest(throughput_.intensity()) * eta_ * eta_, most);
        if (!(sampler_.next() < survival)) return false;
        throughput_.scale(1 / survival);
        return true;
    }
    bool carries_light() const { return largest(throughput_.intensity()) > 0; }

  private:
    const Bsdf& bsdf() const { return scene_.bsdfs[scene_.geometry.shapes[hit_.shape].bsdf]; }
    bool is_null(int shape) const {
        return std::holds_alternative<Null>(scene_.bsdfs[scene_.geometry.shapes[shape].bsdf].model);
    }
    ShadingPoint shading_point() const { return {&w_, point_.uv, scene_.bsdfs.data()}; }
    void add(const StokesPacket& stokes, int events) { record_.add(stokes, classes_.path_class(events)); }

    void follow(BsdfSample& sample, ScatteringEvent event) {
        events_ = classes_.after(events_, event);
        go_on(sample);
    }
    // From the surface point into the direction of a sample.
    void go_on(BsdfSample& sample) {
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
        counts_passing_ = false;
        const Vec3 direction = point_.frame.to_world(sample.incident).normalized();
        medium_ = side_medium(direction);
        ray_ = {point_.origin(direction), direction, INFINITY, ray_.time};
    }

    // Light of a lamp that enters translucent matter at the point.
    void add_direct_light_below(const Dipole& matter) {
        if (!scene_.lights.any_sampled()) return;
        LightSample light;
        const float choice = sampler_.next();
        if (!scene_.lights.sample(scene_.geometry, point_.position, w_, choice, sampler_.next2(), light)) return;
        const Vec3 incident = point_.frame.to_local(light.direction);
        if (incident.z() <= 0) return;
        const Float4 passed = transmittance(light, point_.origin(light.direction), medium_);
        if (largest(passed) <= 0) return;
        const float share = light.delta ? 1.0f : power_heuristic(light.pdf, incident.z() * inv_pi_f);
        ScatteringMatrix matrix;
        matter.enter(w_, incident, matrix);
        axes_to_world(matrix);
        add(arriving(throughput_, scene_.lights, light.emitter, passed * light.radiance * (share / light.pdf),
                     -light.direction, matrix, -light.direction),
            events_);
    }

    // Each wavelength's share of what the path carries.
    Float4 shares() const {
        const Float4 carried = throughput_.intensity();
        return carried / sum(carried);
    }

    float share_of_scattering(float light_pdf) const {
        return last_delta_ || light_pdf <= 0 ? 1.0f : power_heuristic(last_pdf_, light_pdf);
    }

    // The medium behind a surface for who goes through it along `direction`.
    int behind(const SurfacePoint& at, const Vec3& direction, int before) const {
        const Shape& shape = scene_.geometry.shapes[at.shape];
        if (!shape.bounds_media()) return before;
        return at.geometric_normal.dot(direction) < 0 ? shape.interior : shape.exterior;
    }
    // The medium a ray from the surface into `direction` is in.
    int side_medium(const Vec3& direction) const {
        const bool through = point_.geometric_normal.dot(direction) * point_.geometric_normal.dot(ray_.direction) > 0;
        return through ? behind(point_, direction, medium_) : medium_;
    }

    // What media and boundaries between a point and a lamp let pass.
    Float4 transmittance(const LightSample& light, const Vec3& from, int medium) const {
        Ray ray{from, light.direction, INFINITY, ray_.time};
        // Stop short of the lamp itself; a share of the distance covers the rounding of its position.
        const float short_of = 1e-4f * light.distance;
        float rest = light.distance;
        Float4 passed = splat(1);
        while (largest(passed) > 0) {
            Hit hit;
            ray.t_max = rest < INFINITY ? rest - short_of : INFINITY;
            hit.t = ray.t_max;
            const bool found = scene_.geometry.intersect(ray, hit);
            if (found && !is_null(hit.shape)) return splat(0);
            if (medium != vacuum)
                passed *= Medium::transmittance(scene_.media[medium].extinction.at(w_), found ? hit.t : rest);
            if (!found) break;
            const SurfacePoint point = scene_.geometry.surface(ray, hit);
            medium = behind(point, ray.direction, medium);
            ray.origin = point.origin(ray.direction);
            rest -= hit.t;
        }
        return passed;
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
    int medium_;
    bool found_ = false;
    Hit hit_;
    SurfacePoint point_;
    Vec3 position_ = Vec3::Zero();           // of a particle
    int events_ = LightPathClassifier::eye;  // what the path has met, as the classifier's state
    Vec3 last_position_ = Vec3::Zero();
    float last_pdf_ = 0, eta_ = 1;
    bool last_delta_ = true, hero_only_ = false;
    bool counts_passing_ = false;  // last_pdf_ includes the chance to have come this far
};

}  // namespace

void VolumetricIntegrator::trace(const TransportProblem& problem, const Sensor::CameraRay& camera,
                                 const Wavelengths& wavelengths, Sampler& sampler, PathRecord& record) const {
    VolumePath path(problem, camera, wavelengths, sampler, record);
    int depth = 0;
    for (std::uint32_t step = 0; settings_.max_depth < 0 || depth < settings_.max_depth; ++step) {
        sampler.seek(first_draw + draws_per_step * step);
        const bool show = depth > 0 || !settings_.hide_emitters;
        const bool last = settings_.max_depth >= 0 && depth + 1 >= settings_.max_depth;

        // Meet a particle, a surface, or leave the scene.
        const bool found = path.find_surface();
        const bool particle = path.meets_particle();
        if (!particle) {
            if (!path.carries_light()) break;
            if (!found) {
                if (show) path.add_environment();
                break;
            }
            if (show) path.add_emission();
            if (path.at_null()) {
                path.cross_boundary();
                continue;
            }
        }
        record.hit = true;
        if (last || !path.carries_light()) break;

        // Gather direct light, and go on.
        if (particle) {
            path.add_direct_light_at_particle();
            path.scatter_at_particle();
        } else if (const Dipole* matter = path.translucent()) {
            if (!path.scatter_in_matter(*matter)) break;
        } else {
            path.add_direct_light_at_surface();
            if (!path.scatter_at_surface()) break;
        }
        if (!path.carries_light()) break;
        if (++depth >= settings_.rr_depth &&
            !path.survives_roulette(particle ? likely_survival_in_medium : likely_survival_at_surface))
            break;
    }
}

}  // namespace patina::render
