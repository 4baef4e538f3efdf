#include "patina/render/integrators/path.h"

#include <optional>

#include "patina/core/contract.h"
#include "patina/render/arriving_light.h"
#include "patina/render/mueller_packet.h"
#include "patina/render/realizability.h"
#include "patina/render/scene.h"

namespace patina::render {

namespace {

// The random draws of a vertex, in this order after those that belong to the camera.
constexpr std::uint32_t first_draw = 8, draws_per_vertex = 8;
enum VertexDraw : std::uint32_t { light_choice, light_point, lobe_choice, lobe_direction, roulette };

// An event of which the throughput has the first column only, as long as nothing but unpolarized light arrives there:
// enough to complete it. Three quarters of a paint's table can be spared where the path meets a lamp, the sky or a
// depolarizer next.
struct AbbreviatedEvent {
    Throughput before;
    const Bsdf* bsdf;
    SurfacePoint point;
    Vec3 outgoing, incident;  // local
    float factor;             // that makes a weight of the model's value
};
using AbbreviatedSlot = std::optional<AbbreviatedEvent>;

bool may_abbreviate(const Bsdf& bsdf) {
    return std::holds_alternative<Paint>(bsdf.model);
}
bool may_abbreviate(const Scene& scene) {
    return !scene.lights.any_polarized() &&
           std::ranges::any_of(scene.bsdfs, [](const Bsdf& bsdf) { return may_abbreviate(bsdf); });
}

// One path being traced: where it is, what it carries, and how the last step was drawn.
class PathState {
  public:
    // `last_event` is where the path keeps its abbreviated event; null: it is not to abbreviate any.
    PathState(const TransportProblem& problem, bool one_class, CameraSample& sample, AbbreviatedSlot* last_event)
        : scene_(problem.scene),
          classes_(problem.classes),
          one_class_(one_class),
          last_event_(last_event),
          sample_(sample),
          ray_(sample.camera.ray),
          throughput_(sample.camera.stokes_axis) {}

    const Ray& ray() const { return ray_; }
    const Sampler& sampler() const { return sample_.sampler; }

    void meet(const Hit& hit) {
        hit_ = hit;
        scene_.geometry.find_surface(ray_, hit, point_);
        if (has_abbreviated() && !depolarizes(bsdf())) complete_last_event();
    }
    void note_camera_hit(bool hit) { sample_.record->hit = hit; }

    // Light of the environments that the last direction ran into.
    void add_environment() {
        scene_.lights.for_each_environment(ray_.direction, w(), [&](Float4 radiance, float light_pdf, int emitter) {
            add(arriving(throughput_, scene_.lights, emitter, radiance * share_of_scattering(light_pdf),
                         -ray_.direction),
                events_);
        });
    }

    // Light of the surface itself.
    void add_emission() {
        const int emitter = scene_.geometry.shapes[hit_.shape].emitter;
        if (emitter < 0) return;
        const Float4 radiance = scene_.lights.surface_radiance(emitter, point_, -ray_.direction, w());
        if (largest(radiance) <= 0) return;
        const float light_pdf =
            last_delta_ ? 0.0f : scene_.lights.surface_pdf(emitter, scene_.geometry, hit_, point_, last_position_);
        add(arriving(throughput_, scene_.lights, emitter, radiance * share_of_scattering(light_pdf), -ray_.direction),
            events_);
    }

    bool may_be_lit() const { return scene_.lights.any_sampled() && !bsdf_is_delta(bsdf(), shading_point()); }

    // Draws a lamp and scatters its light here; false: none. What is added once nothing is found in the shadow ray's
    // way.
    bool draw_direct_light(float choice, const Vec2& u, Ray& shadow) {
        ShadingPoint shading = shading_point();
        shading.unpolarized_light = !scene_.lights.any_polarized();
        LightSample light;
        if (!scene_.lights.sample(scene_.geometry, point_.position, w(), choice, u, light)) return false;
        BsdfValue value;
        const Vec3 outgoing = point_.frame.to_local(-ray_.direction), incident = point_.frame.to_local(light.direction);
        if (!bsdf_evaluate(bsdf(), shading, outgoing, incident, value)) return false;
        const float share = light.delta ? 1.0f : power_heuristic(light.pdf, value.pdf);
        axes_to_world(point_.frame, value.f);
        direct_ = arriving(throughput_, scene_.lights, light.emitter, light.radiance * (share / light.pdf),
                           -light.direction, value.f, -ray_.direction);
        direct_events_ = after_continuous_event(shading, outgoing);
        // Stop short of the lamp itself; a share of the distance covers the rounding of its position.
        shadow = {point_.origin(light.direction), light.direction, light.distance * (1 - 1e-4f), ray_.time};
        return true;
    }
    void add_direct_light() { add(direct_, direct_events_); }

    // Turns into the next direction; false: the path ends.
    bool scatter(float lobe, const Vec2& u) {
        BsdfSample sample;
        const Vec3 outgoing = point_.frame.to_local(-ray_.direction);
        ShadingPoint shading = shading_point();
        const bool abbreviate = last_event_ && may_abbreviate(bsdf());
        shading.unpolarized_light = abbreviate;
        const bool may_even = evened_choices_ < most_evened_choices && !throughput_.depolarized();
        if (may_even) shading.least_share = least_share_of_a_way;
        if (!bsdf_sample(bsdf(), shading, outgoing, lobe, u, sample)) return false;
        if (may_even && sample.delta && sample.pdf <= 1 - least_share_of_a_way) ++evened_choices_;
        events_ = sample.delta && !one_class_ ? classes_.after(events_, ScatteringEvent::specular)
                                              : after_continuous_event(shading, outgoing);
        axes_to_world(point_.frame, sample.weight);
        if (last_event_) last_event_->reset();
        if (abbreviate && !sample.delta) {
            last_event_->emplace(throughput_, &bsdf(), point_, outgoing, sample.incident, 1 / sample.pdf);
            throughput_.append_for_unpolarized(sample.weight, -ray_.direction);
        } else {
            append(sample.weight, -ray_.direction);
        }
        if (sample.dispersed && !hero_only_) {
            hero_only_ = true;
            throughput_.keep_only_hero();
        }
        eta_ *= sample.eta;
        last_position_ = point_.position;
        last_pdf_ = sample.pdf;
        last_delta_ = sample.delta;
        ray_.direction = straightened(point_.frame.to_world(sample.incident));
        ray_.origin = point_.origin(ray_.direction);
        ray_.t_max = INFINITY;
        return largest(throughput_.intensity()) > 0;
    }

    // Ends paths that carry little; false: ended. Radiance inside a dense medium is larger without being worth more.
    bool survives_roulette(float u) {
        const float carried = largest(throughput_.intensity()) * eta_ * eta_;
        const float survival = std::min(carried, 0.95f);
        if (!(u < survival)) return false;
        throughput_.scale(1 / survival);
        if (has_abbreviated()) (*last_event_)->factor /= survival;
        return true;
    }

  private:
    // Reflection off glass carries little light but much of the polarization, so the rarer of two ways is taken with at
    // least this probability; only at the first two such events, for the weights of the other way multiply.
    static constexpr float least_share_of_a_way = 0.25f;
    static constexpr int most_evened_choices = 2;

    static bool depolarizes(const Bsdf& bsdf) {
        return std::holds_alternative<Diffuse>(bsdf.model) || std::holds_alternative<OrenNayar>(bsdf.model);
    }
    bool has_abbreviated() const { return last_event_ && last_event_->has_value(); }
    void complete_last_event() {
        const AbbreviatedEvent& event = **last_event_;
        const ShadingPoint shading{&w(), event.point.uv, scene_.bsdfs.data()};
        BsdfValue value;
        bsdf_evaluate(*event.bsdf, shading, event.outgoing, event.incident, value);
        value.f.scale(splat(event.factor));
        axes_to_world(event.point.frame, value.f);
        throughput_ = event.before;
        append(value.f, event.point.frame.to_world(event.outgoing));
        last_event_->reset();
    }
    const Wavelengths& w() const { return sample_.wavelengths; }
    const Bsdf& bsdf() const { return scene_.bsdfs[scene_.geometry.shapes[hit_.shape].bsdf]; }
    ShadingPoint shading_point() const { return {&w(), point_.uv, scene_.bsdfs.data()}; }
    void add(const StokesPacket& stokes, int events) {
        sample_.record->add(stokes, one_class_ ? 0 : classes_.path_class(events));
    }

    // The classifier's state after an event that is no delta function; where all paths are of one class it stays.
    int after_continuous_event(const ShadingPoint& shading, const Vec3& outgoing) const {
        if (one_class_) return events_;
        return classes_.after(events_, continuous_event(bsdf(), shading, outgoing));
    }
    float share_of_scattering(float light_pdf) const {
        return last_delta_ || light_pdf <= 0 ? 1.0f : power_heuristic(last_pdf_, light_pdf);
    }
    static void axes_to_world(const Frame& frame, ScatteringMatrix& m) {
        if (m.form == ScatteringMatrix::Form::depolarizing) return;
        m.x_in = frame.to_world(m.x_in);
        m.x_out = frame.to_world(m.x_out);
    }
    void append(const ScatteringMatrix& event, const Vec3& outgoing) {
#ifndef NDEBUG
        const Throughput before = throughput_;
#endif
        throughput_.append(event, outgoing);
#ifndef NDEBUG
        // Tables of measurements need not be realizable, and rounding is not.
        events_realizable_ = events_realizable_ && is_realizable(event) && !extinguishes(event, before, throughput_);
        PATINA_ASSERT(!events_realizable_ || is_realizable(throughput_));
#endif
    }

    const Scene& scene_;
    const LightPathClassifier& classes_;
    const bool one_class_;               // events need not be told apart
    AbbreviatedSlot* const last_event_;  // filled if the throughput has no more than its first column
    CameraSample& sample_;
    Ray ray_;
    Throughput throughput_;
    Hit hit_;
    SurfacePoint point_;
    int events_ = LightPathClassifier::eye;  // what the path has met, as the classifier's state
    Vec3 last_position_ = Vec3::Zero();
    float last_pdf_ = 0, eta_ = 1;
    int evened_choices_ = 0;
    bool last_delta_ = true, hero_only_ = false;
    StokesPacket direct_;  // light of a lamp, if nothing is in its way
    int direct_events_ = 0;
#ifndef NDEBUG
    bool events_realizable_ = true;
#endif
};

// Paths that go on side by side: rays are cast and random numbers drawn for many of them at once. What a path
// brings depends on none but its own numbers.
class PathBlock {
  public:
    PathBlock(const TransportProblem& problem, const PathIntegrator::Settings& settings,
              std::span<CameraSample> samples)
        : geometry_(problem.scene.geometry), choose_lamps_(problem.scene.lights.must_choose()), settings_(settings) {
        paths_.reserve(samples.size());
        alive_.reserve(samples.size());
        lit_.reserve(samples.size());
        const bool one_class = problem.classes.class_count() == 1;
        if (may_abbreviate(problem.scene)) abbreviated_.resize(samples.size());
        for (std::size_t i = 0; i < samples.size(); ++i)
            alive_.push_back(&paths_.emplace_back(problem, one_class, samples[i],
                                                  abbreviated_.empty() ? nullptr : &abbreviated_[i]));
    }

    void trace() {
        for (int depth = 0; !alive_.empty() && (settings_.max_depth < 0 || depth < settings_.max_depth); ++depth) {
            find_surfaces(depth);
            if (settings_.max_depth >= 0 && depth + 1 >= settings_.max_depth) return;
            gather_direct_light(depth);
            scatter(depth);
        }
    }

  private:
    using Paths = std::vector<PathState*>;

    // Meets surfaces and sees what shines; paths that leave the scene end.
    void find_surfaces(int depth) {
        const bool show = depth > 0 || !settings_.hide_emitters;
        keep_where([&](std::span<PathState*> group, std::uint32_t& alive) {
            const int count = static_cast<int>(group.size());
            RayBlock rays;
            Hit hits[wide_lanes];
            for (int k = 0; k < count; ++k) rays.set(k, group[k]->ray());
            geometry_.intersect(rays, count, hits);
            for (int k = 0; k < count; ++k) {
                PathState& path = *group[k];
                const bool found = hits[k].shape >= 0;
                if (depth == 0) path.note_camera_hit(found);
                if (found) {
                    path.meet(hits[k]);
                    if (show) path.add_emission();
                    alive |= 1u << k;
                } else if (show) {
                    path.add_environment();
                }
            }
        });
    }

    // Adds the light of a lamp drawn at random, scattered once.
    void gather_direct_light(int depth) {
        lit_.clear();
        for (PathState* path : alive_)
            if (path->may_be_lit()) lit_.push_back(path);
        for_groups(lit_, [&](std::span<PathState*> group) {
            FloatLanes choice, x, y;
            const SamplerBlock draws = samplers(group);
            if (choose_lamps_) choice.store(draws.next(draw(depth, light_choice)));
            draws.next2(draw(depth, light_point), x, y);
            RayBlock shadows;
            PathState* waiting[wide_lanes];
            int count = 0;
            for (std::size_t k = 0; k < group.size(); ++k) {
                Ray shadow;
                if (!group[k]->draw_direct_light(choice[k], {x[k], y[k]}, shadow)) continue;
                shadows.set(count, shadow);
                waiting[count++] = group[k];
            }
            const std::uint32_t blocked = geometry_.occluded(shadows, count);
            for (int k = 0; k < count; ++k)
                if (!(blocked >> k & 1)) waiting[k]->add_direct_light();
        });
    }

    // Draws the next directions; paths that are absorbed or carry little end.
    void scatter(int depth) {
        keep_where([&](std::span<PathState*> group, std::uint32_t& alive) {
            const SamplerBlock draws = samplers(group);
            FloatLanes lobe, x, y, fate;
            lobe.store(draws.next(draw(depth, lobe_choice)));
            draws.next2(draw(depth, lobe_direction), x, y);
            const bool at_risk = depth + 1 >= settings_.rr_depth;
            if (at_risk) fate.store(draws.next(draw(depth, roulette)));
            for (std::size_t k = 0; k < group.size(); ++k)
                if (group[k]->scatter(lobe[k], {x[k], y[k]}) && (!at_risk || group[k]->survives_roulette(fate[k])))
                    alive |= 1u << k;
        });
    }

    static std::uint32_t draw(int depth, VertexDraw which) {
        return first_draw + draws_per_vertex * static_cast<std::uint32_t>(depth) + which;
    }
    static SamplerBlock samplers(std::span<PathState*> group) {
        SamplerBlock block;
        for (std::size_t k = 0; k < group.size(); ++k) block.set(static_cast<int>(k), group[k]->sampler());
        return block;
    }
    template <class Step>
    static void for_groups(Paths& paths, const Step& step) {
        for (std::size_t first = 0; first < paths.size(); first += wide_lanes)
            step(std::span(paths).subspan(first, std::min<std::size_t>(wide_lanes, paths.size() - first)));
    }
    // Takes a step with all living paths; it marks those of a group that go on.
    template <class Step>
    void keep_where(const Step& step) {
        std::size_t kept = 0;
        for_groups(alive_, [&](std::span<PathState*> group) {
            std::uint32_t alive = 0;
            step(group, alive);
            for (std::size_t k = 0; k < group.size(); ++k)
                if (alive >> k & 1) alive_[kept++] = group[k];
        });
        alive_.resize(kept);
    }

    const Geometry& geometry_;
    const bool choose_lamps_;
    const PathIntegrator::Settings& settings_;
    std::vector<AbbreviatedSlot> abbreviated_;  // of the paths; empty: nothing can be abbreviated
    std::vector<PathState> paths_;
    Paths alive_, lit_;
};

}  // namespace

void PathIntegrator::trace(const TransportProblem& problem, const Sensor::CameraRay& camera,
                           const Wavelengths& wavelengths, Sampler& sampler, PathRecord& record) const {
    CameraSample sample{camera, wavelengths, sampler, &record};
    trace_block(problem, {&sample, 1});
}

void PathIntegrator::trace_block(const TransportProblem& problem, std::span<CameraSample> samples) const {
    PathBlock(problem, settings_, samples).trace();
}

}  // namespace patina::render
