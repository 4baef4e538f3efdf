#include "patina/render/emitters.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "patina/core/contract.h"

namespace patina::render {

namespace {

struct PowerOf {
    const Geometry& geometry;

    float operator()(const AreaEmitter& e) const { return pi_f * geometry.shapes[e.shape].area * e.radiance.average(); }
    float operator()(const PointEmitter& e) const { return 4 * pi_f * e.intensity.average(); }
    float operator()(const DirectionalEmitter& e) const {
        return pi_f * sqr(geometry.radius()) * e.irradiance.average();
    }
    float operator()(const SpotEmitter& e) const {
        const float solid_angle = 2 * pi_f * (1 - std::cos(0.5f * (e.cutoff_rad + e.beam_width_rad)));
        return solid_angle * e.intensity.average() * (e.slide ? e.slide->mean_factor() : 1.0f);
    }
    float operator()(const ConstantEmitter& e) const {
        return sqr(2 * pi_f * geometry.radius()) * e.radiance.average();
    }
    float operator()(const EnvironmentEmitter& e) const {
        return sqr(pi_f * geometry.radius()) * static_cast<float>(e.rows.total()) * e.illuminant.average();
    }
};

// A sphere that holds a lamp, and where it shines; nothing for what is at infinity. The power is left to the caller.
struct BoundsOf {
    const Geometry& geometry;
    using Bounds = std::optional<LampBounds>;

    Bounds operator()(const PointEmitter& e) const { return LampBounds{e.position, 0, 0, {}}; }
    Bounds operator()(const SpotEmitter& e) const {
        LampBounds bounds{e.position, 0, 0, {}};
        if (e.cutoff_rad < 0.5f * pi_f) bounds.cone = {e.axis, e.cutoff_rad, spot_edge_rad};
        return bounds;
    }
    Bounds operator()(const AreaEmitter& e) const {
        const Shape& shape = geometry.shapes[e.shape];
        if (shape.is_mesh) return of_mesh(geometry.meshes[shape.first]);
        LampBounds bounds{Vec3::Zero(), 0, 0, {}};
        for (int i = 0; i < shape.count; ++i) bounds.centre += geometry.analytic[shape.first + i].o / shape.count;
        for (int i = 0; i < shape.count; ++i) {
            const AnalyticShape& s = geometry.analytic[shape.first + i];
            const float reach = s.kind == AnalyticShape::Kind::sphere ? s.radius : s.a.norm() + s.b.norm();
            bounds.radius = std::max(bounds.radius, (s.o - bounds.centre).norm() + reach);
            if (shape.count == 1 && s.kind != AnalyticShape::Kind::sphere)
                bounds.cone = {s.flipped ? Vec3(-s.n) : s.n, 0, 0.5f * pi_f};
        }
        return bounds;
    }
    Bounds operator()(const DirectionalEmitter&) const { return {}; }
    Bounds operator()(const ConstantEmitter&) const { return {}; }
    Bounds operator()(const EnvironmentEmitter&) const { return {}; }

  private:
    // Light that falls off to nothing at the cutoff may be cut off a rounding error beyond it.
    static constexpr float spot_edge_rad = 1e-3f;

    // A mesh may shine anywhere.
    static LampBounds of_mesh(const MeshShape& m) {
        Vec3 low = m.mesh->positions.front(), high = low;
        for (const Vec3& p : m.mesh->positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
        return {0.5f * (low + high), 0.5f * (high - low).norm(), 0, {}};
    }
};

struct Draw {
    const Geometry& geometry;
    const Vec3& from;
    const Wavelengths& w;
    const Vec2& u;
    LightSample& out;

    bool operator()(const AreaEmitter& e) const {
        ShapeSample at;
        const Vec2 place = e.table ? e.table->sample(u, out.area_density) : u;
        if (!geometry.sample_shape(e.shape, from, place, at)) return false;
        out.distance = at.distance;
        out.direction = at.direction;
        out.normal = at.normal;
        out.pdf = at.pdf * out.area_density;
        out.radiance = e.radiance.at(w, at.uv);
        return true;
    }
    bool operator()(const PointEmitter& e) const { return towards(e.position, e.intensity.at(w)); }
    bool operator()(const SpotEmitter& e) const {
        const Float4 intensity = e.intensity_along(w, (from - e.position).normalized());
        return largest(intensity) > 0 && towards(e.position, intensity);
    }
    bool operator()(const DirectionalEmitter& e) const {
        out.direction = -e.direction;
        out.delta = true;
        out.pdf = 1;
        out.radiance = e.irradiance.at(w);
        return true;
    }
    bool operator()(const ConstantEmitter&) const { return false; }
    bool operator()(const EnvironmentEmitter& e) const {
        e.sample(u, out.direction, out.pdf);
        if (out.pdf <= 0) return false;
        out.radiance = e.radiance(w, out.direction);
        return true;
    }

  private:
    bool towards(const Vec3& position, Float4 intensity) const {
        const Vec3 d = position - from;
        const float distance2 = d.squaredNorm();
        if (distance2 == 0) return false;
        out.distance = std::sqrt(distance2);
        out.direction = d / out.distance;
        out.delta = true;
        out.pdf = 1;
        out.radiance = intensity / distance2;
        return true;
    }
};

}  // namespace

float SpotEmitter::falloff(const Vec3& direction) const {
    const float cos = axis.dot(direction);
    if (cos <= std::cos(cutoff_rad)) return 0;
    if (cos >= std::cos(beam_width_rad)) return 1;
    return (cutoff_rad - std::acos(cos)) / (cutoff_rad - beam_width_rad);
}

Float4 Slide::at(const Wavelengths& w, const Vec3& direction) const {
    const Vec3 local = to_local * direction;
    if (local.z() <= 0) return splat(0);
    const Vec2 uv(0.5f + 0.5f * local.x() / (local.z() * tan_u), 0.5f + 0.5f * local.y() / (local.z() * tan_v));
    if (!projects) return picture.at(w, uv);
    if (uv.minCoeff() < 0 || uv.maxCoeff() > 1) return splat(0);
    // I = E / cos^3 for the irradiance E on a plane at distance 1.
    return picture.at(w, uv) * (pi_f / (local.z() * local.z() * local.z()));
}

float Slide::mean_factor() const {
    if (!projects) return picture.average();
    // Power pi E A over the solid angle of the cone about the slide's corners.
    const float corner = 1 / std::sqrt(1 + sqr(tan_u) + sqr(tan_v));
    return pi_f * picture.average() * 4 * std::abs(tan_u * tan_v) / (2 * pi_f * (1 - corner));
}

float emitted_power(const Emitter& emitter, const Geometry& geometry) {
    return std::visit(PowerOf{geometry}, emitter);
}

Lights::Lights(std::vector<Emitter> emitters, const Geometry& geometry, std::vector<EmitterPolarization> states)
    : emitters_(std::move(emitters)),
      states_(std::move(states)),
      slot_(emitters_.size(), -1),
      lamp_(emitters_.size(), -1) {
    states_.resize(emitters_.size());
    for (const EmitterPolarization& state : states_) any_polarized_ |= state.polarized();
    for (int i = 0; i < static_cast<int>(emitters_.size()); ++i)
        if (std::holds_alternative<ConstantEmitter>(emitters_[i]) ||
            std::holds_alternative<EnvironmentEmitter>(emitters_[i]))
            environments_.push_back(i);
    prepare_choice(geometry);
}

void Lights::prepare_choice(const Geometry& geometry) {
    std::vector<double> powers;
    std::vector<LampBounds> lamps;
    int slot_of_lamps = -1;
    const auto somewhere = [&](const Emitter& e) { return std::visit(BoundsOf{geometry}, e).has_value(); };
    const bool many = std::ranges::count_if(emitters_, somewhere) >= many_lamps;
    for (int i = 0; i < static_cast<int>(emitters_.size()); ++i) {
        if (std::holds_alternative<ConstantEmitter>(emitters_[i])) continue;
        const double power = emitted_power(emitters_[i], geometry);
        const std::optional<LampBounds> bounds = many ? std::visit(BoundsOf{geometry}, emitters_[i]) : std::nullopt;
        if (!bounds || slot_of_lamps < 0) {
            if (bounds) slot_of_lamps = static_cast<int>(sampled_.size());
            sampled_.push_back(bounds ? -1 : i);
            powers.push_back(0);
        }
        slot_[i] = bounds ? slot_of_lamps : static_cast<int>(sampled_.size()) - 1;
        powers[slot_[i]] += power;
        if (!bounds) continue;
        lamp_[i] = static_cast<int>(lamps_.size());
        lamps_.push_back(i);
        lamps.push_back(*bounds);
        lamps.back().power = static_cast<float>(power);
    }
    // Dark lights stay, with no chance to be drawn, so that hits on them have a density (0).
    if (std::accumulate(powers.begin(), powers.end(), 0.0) <= 0) powers.assign(powers.size(), 1.0);
    if (!powers.empty()) choice_ = DiscreteDistribution(powers);
    tree_ = LampTree(lamps);
}

bool Lights::sample(const Geometry& geometry, const Vec3& from, const Wavelengths& w, float u, const Vec2& u2,
                    LightSample& sample) const {
    const DiscreteDistribution::Choice choice = choice_.sample(u);
    int emitter = sampled_[choice.index];
    float probability = choice.probability;
    if (emitter < 0) {
        const LampTree::Choice lamp = tree_.choose(from, choice.remainder);
        if (lamp.lamp < 0) return false;
        emitter = lamps_[lamp.lamp];
        probability *= lamp.probability;
    }
    if (!sample_emitter(emitter, geometry, from, w, u2, sample)) return false;
    sample.pdf *= probability;
    return true;
}

bool Lights::sample_emitter(int emitter, const Geometry& geometry, const Vec3& from, const Wavelengths& w,
                            const Vec2& u2, LightSample& sample) const {
    sample.delta = false;
    sample.area_density = 1;
    sample.distance = INFINITY;
    sample.emitter = emitter;
    return std::visit(Draw{geometry, from, w, u2, sample}, emitters_[emitter]);
}

bool Lights::is_delta(int emitter) const {
    const Emitter& e = emitters_[emitter];
    return std::holds_alternative<PointEmitter>(e) || std::holds_alternative<SpotEmitter>(e) ||
           std::holds_alternative<DirectionalEmitter>(e);
}

}  // namespace patina::render
