#include "patina/render/emitters.h"

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
        return 2 * pi_f * (1 - std::cos(0.5f * (e.cutoff_rad + e.beam_width_rad))) * e.intensity.average();
    }
    float operator()(const ConstantEmitter& e) const {
        return sqr(2 * pi_f * geometry.radius()) * e.radiance.average();
    }
    float operator()(const EnvironmentEmitter& e) const {
        return sqr(pi_f * geometry.radius()) * static_cast<float>(e.rows.total()) * e.illuminant.average();
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
        if (!geometry.sample_shape(e.shape, from, u, at)) return false;
        const Vec3 d = at.position - from;
        out.distance = d.norm();
        out.direction = d * (1 / out.distance);
        if (out.direction.dot(at.normal) >= 0) return false;
        out.normal = at.normal;
        out.pdf = at.pdf;
        out.radiance = e.radiance.at(w, at.uv);
        return true;
    }
    bool operator()(const PointEmitter& e) const { return towards(e.position, e.intensity.at(w)); }
    bool operator()(const SpotEmitter& e) const {
        const float falloff = e.falloff((from - e.position).normalized());
        return falloff > 0 && towards(e.position, falloff * e.intensity.at(w));
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

float emitted_power(const Emitter& emitter, const Geometry& geometry) {
    return std::visit(PowerOf{geometry}, emitter);
}

Lights::Lights(std::vector<Emitter> emitters, const Geometry& geometry, std::vector<EmitterPolarization> states)
    : emitters_(std::move(emitters)), states_(std::move(states)), slot_(emitters_.size(), -1) {
    states_.resize(emitters_.size());
    for (const EmitterPolarization& state : states_) any_polarized_ |= state.polarized();
    std::vector<double> powers;
    for (int i = 0; i < static_cast<int>(emitters_.size()); ++i) {
        const bool constant = std::holds_alternative<ConstantEmitter>(emitters_[i]);
        if (constant || std::holds_alternative<EnvironmentEmitter>(emitters_[i])) environments_.push_back(i);
        if (constant) continue;
        // A dark light stays in the list with no chance to be drawn, so that hits on it have a density (0).
        const double power = emitted_power(emitters_[i], geometry);
        slot_[i] = static_cast<int>(sampled_.size());
        sampled_.push_back(i);
        powers.push_back(power);
    }
    double total = 0;
    for (double power : powers) total += power;
    if (total > 0) {
        choice_ = DiscreteDistribution(powers);
    } else if (!powers.empty()) {
        choice_ = DiscreteDistribution(std::vector<double>(powers.size(), 1.0));
    }
}

bool Lights::sample(const Geometry& geometry, const Vec3& from, const Wavelengths& w, float u, const Vec2& u2,
                    LightSample& sample) const {
    const DiscreteDistribution::Choice choice = choice_.sample(u);
    if (!sample_emitter(sampled_[choice.index], geometry, from, w, u2, sample)) return false;
    sample.pdf *= choice.probability;
    return true;
}

bool Lights::sample_emitter(int emitter, const Geometry& geometry, const Vec3& from, const Wavelengths& w,
                            const Vec2& u2, LightSample& sample) const {
    sample.delta = false;
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
