#pragma once
// The random walk of one packet through the stack, with a local estimate of what each of its events sends to the
// detectors.
//
// A packet carries the Stokes vectors of its path for one incident Stokes vector (columns = 1) or four (columns = 4, a
// Mueller matrix), scaled so that I of the first column is 1, and a weight. Scattering angle and azimuth, and
// reflection or refraction at interfaces, are drawn from the intensity of the first column with its actual
// polarization, so that the weight changes by absorption only: 0 <= weight <= its start (Russian roulette at most
// restores it), and |other columns| <= 1 since |M_ij| <= M_11 for any Mueller matrix. Expansions whose F is no Mueller
// matrix (truncated too early) break this bound, not the expectation.
//
// Every unscattered way from an event to a detector, internal reflections included, is in the local estimate (cones.h);
// the first collision is drawn from the exact unscattered beam (forced), and specular light is never detected, so that
// the estimate is the diffuse radiance, unbiased.

#include <numbers>

#include "patina/rt/monte_carlo/cones.h"

namespace patina::rt::monte_carlo {

template <int columns>
struct Packet {
    Frame frame;
    StokesColumns<columns> stokes;
    double weight;
    int layer;
    double tau;  // depth inside the layer
};

// Where the unscattered beam first scatters, drawn in proportion to the intensity that does so there.
inline constexpr int top_surface = -2;

template <int columns>
class FirstCollision {
  public:
    FirstCollision(const Stack& stack, double mu_i, const StokesColumns<columns>& incident) : stack_(stack) {
        if (stack.rough_top) {
            add({top_surface, false, mu_i, 1.0, 1.0, incident}, Gain{1.0, 1.0, 1.0});
            return;
        }
        const SpecularStack specular(stack, stack.index_above * std::sqrt((1.0 - mu_i) * (1.0 + mu_i)));
        const SpecularStack::Beam beam = specular.beam();
        for (int l = 0; l < stack.size(); ++l)
            for (bool up : {false, true}) {
                const double mu = specular.mu(l), albedo = stack.layers[static_cast<std::size_t>(l)].albedo;
                const auto& gains = up ? beam.up_at_bottom : beam.down_at_top;
                const double collided = mu > 0.0 ? -std::expm1(-stack.thickness(l) / mu) : 0.0;
                add({l, up, mu, collided, albedo, incident}, gains[static_cast<std::size_t>(l)]);
            }
        const int last = stack.size() - 1;
        add({-1, false, 1.0, specular.transmission(last), stack.lambertian_reflectance(), incident},
            beam.down_at_top[static_cast<std::size_t>(last)]);
    }

    // Of an incident flux of I = 1 (first column), the part that scatters at all.
    double power() const { return cumulative_.empty() ? 0.0 : cumulative_.back(); }

    // `xi` in (0, 1), which may be stratified, chooses both place and depth. layer = -1 stands for the Lambertian base,
    // top_surface for the rough top.
    Packet<columns> draw(double xi) const {
        double target = xi * power();
        std::size_t c = 0;
        while (c + 1 < cumulative_.size() && target >= cumulative_[c]) ++c;
        if (c > 0) target -= cumulative_[c - 1];
        const Source& source = sources_[c];
        const double fraction = std::clamp(target / (cumulative_[c] - (c > 0 ? cumulative_[c - 1] : 0.0)), 0.0, 1.0);

        // Depth from the truncated exponential.
        Packet<columns> packet{meridian_frame(source.up ? source.mu : -source.mu, 1.0, 0.0), source.stokes,
                               power() / source.albedo, source.layer, 0.0};
        if (source.layer >= 0) {
            const double path = -source.mu * std::log1p(-fraction * source.collided);
            packet.tau = source.up ? stack_.thickness(source.layer) - path : path;
        }
        return packet;
    }

  private:
    struct Source {
        int layer;
        bool up;
        double mu;
        double collided;  // of the beam's flux at its entry
        double albedo;    // of layer or base
        StokesColumns<columns> stokes;
    };
    void add(Source source, const Gain& gain) {
        apply(gain, source.stokes);
        const double intensity = source.stokes(0, 0);
        const double scattered = intensity * source.collided * source.albedo;
        if (!(scattered > 0.0)) return;
        cumulative_.push_back(power() + scattered);
        source.stokes /= intensity;
        sources_.push_back(source);
    }

    const Stack& stack_;
    std::vector<Source> sources_;
    std::vector<double> cumulative_;
};

// Sink::each(cone, gain, radiance) adds gain * radiance(cos azimuth, sin azimuth), Stokes columns, for the azimuths it
// wants of a cone.
template <int columns, class Sink>
class Walk {
  public:
    Walk(const Stack& stack, const std::vector<Cone>& cones, RandomStream& random, Sink& sink)
        : stack_(stack), cones_(cones), random_(random), sink_(sink) {}

    // `start_weight`: of the packet after its first scattering.
    void run(const Packet<columns>& packet, double start_weight) {
        packet_ = packet;
        start_weight_ = start_weight;
        bool alive = true;
        if (packet.layer >= 0) alive = collide();
        if (packet.layer == -1) alive = leave_lambertian();
        if (packet.layer == top_surface) alive = meet_rough_top();
        while (alive) alive = fly() && collide();
    }

  private:
    static constexpr double roulette_below = 0.1, roulette_restores = 0.5;  // in units of the starting weight

    const StackLayer& layer() const { return stack_.layers[static_cast<std::size_t>(packet_.layer)]; }

    // Kills weak packets without bias: survivors carry the weight of the dead.
    bool survives() {
        const double relative = std::abs(packet_.weight) / start_weight_;
        if (relative >= roulette_below) return true;
        const double chance = relative / roulette_restores;
        if (random_.uniform() >= chance) return false;
        packet_.weight /= chance;
        return true;
    }

    // Scales I back to 1 after an event drawn with probability (density) `chance` relative to the packet's intensity.
    bool normalize(double chance) {
        const double intensity = packet_.stokes(0, 0);
        if (intensity == 0.0 || !(chance > 0.0)) return false;
        packet_.weight *= intensity / chance;
        packet_.stokes /= intensity;
        return true;
    }

    bool collide() {
        packet_.weight *= layer().albedo;
        if (packet_.weight == 0.0) return false;
        estimate_scattering();
        return survives() && scatter();
    }

    void estimate_scattering() {
        const double intensity = packet_.weight / (4.0 * std::numbers::pi);
        for (std::size_t c = 0; c < cones_.size(); ++c) {
            const double mu = cones_[c].mu(packet_.layer);
            if (mu == 0.0) continue;
            for (bool up : {true, false}) {
                const Gain gain = cones_[c].gain(packet_.layer, packet_.tau, up);
                if (gain.is_zero()) continue;
                const double sine = std::sqrt((1.0 - mu) * (1.0 + mu)), cosine = up ? mu : -mu;
                sink_.each(c, (intensity / mu) * gain, [&](double cos_azimuth, double sin_azimuth) {
                    return scatter_into<columns>(packet_.frame, packet_.stokes, layer().table, sine, cosine,
                                                 cos_azimuth, sin_azimuth);
                });
            }
        }
    }

    bool scatter() {
        const double x = layer().table.sample_cosine(random_);
        const ScatteringElements f = layer().table.at(x);

        // Azimuth from 1 + rho cos(2 psi - 2 psi0), the intensity of the first column, by rejection.
        const double ratio = f.a1 != 0.0 ? f.b1 / f.a1 : 0.0;
        const double along_q = ratio * packet_.stokes(1, 0), along_u = ratio * packet_.stokes(2, 0);
        const double rho = std::hypot(along_q, along_u), shrink = rho > 1.0 ? 1.0 / rho : 1.0;
        double cosine, sine, density;
        do {
            // A point uniform in the unit disc gives the turn without trigonometry.
            double square;
            do {
                cosine = 2.0 * random_.uniform() - 1.0;
                sine = 2.0 * random_.uniform() - 1.0;
                square = cosine * cosine + sine * sine;
            } while (square > 1.0 || square < 1e-12);
            const double inverse = 1.0 / std::sqrt(square);
            cosine *= inverse;
            sine *= inverse;
            density = 1.0 + shrink * (along_q * (cosine * cosine - sine * sine) + along_u * 2.0 * cosine * sine);
        } while (rho > 0.0 && random_.uniform() * (1.0 + shrink * rho) >= density);

        // Turn the frame to the scattering plane, scatter, bend the ray in it.
        rotate(packet_.stokes, double_angle(cosine, sine, 1.0));
        apply(f, packet_.stokes);
        Frame& frame = packet_.frame;
        const Vector p = cosine * frame.p + sine * frame.s;
        const double sin_scatter = std::sqrt(std::max(0.0, (1.0 - x) * (1.0 + x)));
        const Vector bent = x * p - sin_scatter * frame.k;
        frame.k = x * frame.k + sin_scatter * p;
        // Newton steps towards unit length and orthogonality keep rounding from piling up.
        frame.k *= 1.5 - 0.5 * frame.k.squaredNorm();
        frame.p = bent - bent.dot(frame.k) * frame.k;
        frame.p *= 1.5 - 0.5 * frame.p.squaredNorm();
        frame.s = frame.p.cross(frame.k);
        return normalize(f.density * density);
    }

    // To the next collision; false when the packet has left or was absorbed.
    bool fly() {
        double path = -std::log(random_.uniform());
        if (!skip_guided_cycles(path)) return false;
        for (;;) {
            const bool up = packet_.frame.k.z() > 0.0;
            const double mu = std::max(std::abs(packet_.frame.k.z()), 1e-300);
            const double room = (up ? packet_.tau : layer().thickness - packet_.tau) / mu;
            if (path < room) {
                packet_.tau += up ? -path * mu : path * mu;
                return true;
            }
            path -= room;
            if (up || packet_.layer + 1 < stack_.size()) {
                if (!cross(up)) return false;
            } else if (!meet_base()) {
                return false;
            }
        }
    }

    // Light trapped between total reflection above and total reflection or a metal below may cross a thin layer
    // millions of times before it scatters: takes all full cycles at once. False when the metal has absorbed it.
    bool skip_guided_cycles(double& path) {
        const double mu = std::abs(packet_.frame.k.z()), n = stack_.index(packet_.layer);
        const double cycle = 2.0 * layer().thickness / mu;
        const bool at_metal = packet_.layer + 1 == stack_.size();
        if (packet_.layer == 0 && stack_.rough_top) return true;
        if (!(path > 4.0 * cycle) || (at_metal && !stack_.has_metal())) return true;
        const InterfaceGains top = stack_.interface(mu, n, stack_.index(packet_.layer - 1));
        if (top.cos_t > 0.0) return true;
        Gain bottom;
        if (at_metal) {
            bottom = stack_.mirror(mu);
        } else {
            const InterfaceGains gains = stack_.interface(mu, n, stack_.index(packet_.layer + 1));
            if (gains.cos_t > 0.0) return true;
            bottom = gains.reflect;
        }
        const double cycles = std::floor(path / cycle);
        path -= cycles * cycle;
        turn_to_meridian();
        apply((top.reflect * bottom).power(cycles), packet_.stokes);
        return normalize(1.0) && survives();
    }

    // At an interface: reflects or refracts with the probabilities of the packet's own polarization; false when it
    // leaves.
    bool cross(bool up) {
        const int next = packet_.layer + (up ? -1 : 1);
        if (next < 0 && stack_.rough_top) return meet_rough_top();
        const double n1 = stack_.index(packet_.layer), n2 = stack_.index(next);
        if (n1 != n2) {
            turn_to_meridian();
            const double mu = std::min(1.0, std::abs(packet_.frame.k.z()));
            const InterfaceGains gains = stack_.interface(mu, n1, n2);
            StokesColumns<columns> reflected = packet_.stokes;
            apply(gains.reflect, reflected);
            const double chance = gains.cos_t > 0.0 ? std::clamp(reflected(0, 0), 0.0, 1.0) : 1.0;
            const bool reflects = chance == 1.0 || random_.uniform() < chance;
            if (reflects) {
                packet_.stokes = reflected;
                packet_.tau = up ? 0.0 : layer().thickness;
                return bend(-packet_.frame.k.z(), 1.0) && normalize(chance);
            }
            if (next < 0) return false;
            apply(gains.transmit, packet_.stokes);
            if (!bend(up ? gains.cos_t : -gains.cos_t, n1 / n2) || !normalize(1.0 - chance)) return false;
        }
        if (next < 0) return false;
        packet_.layer = next;
        packet_.tau = up ? layer().thickness : 0.0;
        return true;
    }

    // At a rough top, from either side: sends to the detectors, then goes on into the first layer; false when it
    // leaves.
    bool meet_rough_top() {
        const RoughTop& top = *stack_.rough_top;
        for (std::size_t c = 0; c < cones_.size(); ++c)
            for (bool up : {true, false}) {
                const double mu = cones_[c].mu_at_top(up);
                if (mu == 0.0) continue;
                const Gain gain = cones_[c].gain_from_top(up);
                if (gain.is_zero()) continue;
                const double sine = std::sqrt((1.0 - mu) * (1.0 + mu)), cosine = up ? mu : -mu;
                sink_.each(c, packet_.weight * gain, [&](double cos_azimuth, double sin_azimuth) {
                    return top.template radiance<columns>(packet_.frame, packet_.stokes,
                                                          {sine * cos_azimuth, sine * sin_azimuth, cosine});
                });
            }
        packet_.weight *= top.template draw<columns>(packet_.frame, packet_.stokes, random_);
        if (packet_.weight == 0.0 || packet_.frame.k.z() >= 0.0) return false;
        packet_.layer = 0;
        packet_.tau = 0.0;
        return normalize(1.0) && survives();
    }

    bool meet_base() {
        packet_.tau = layer().thickness;
        if (stack_.has_metal()) {
            turn_to_meridian();
            apply(stack_.mirror(std::min(1.0, std::abs(packet_.frame.k.z()))), packet_.stokes);
            return bend(-packet_.frame.k.z(), 1.0) && normalize(1.0) && survives();
        }
        return leave_lambertian();
    }

    // A Lambertian base forgets direction and polarization; false for a black one.
    bool leave_lambertian() {
        packet_.weight *= stack_.lambertian_reflectance();
        if (packet_.weight == 0.0) return false;
        packet_.stokes.template bottomRows<3>().setZero();
        packet_.layer = stack_.size() - 1;
        packet_.tau = layer().thickness;
        const double radiance = packet_.weight / std::numbers::pi;
        for (std::size_t c = 0; c < cones_.size(); ++c) {
            const Gain gain = cones_[c].gain_from_base();
            if (!gain.is_zero()) sink_.each(c, radiance * gain, [&](double, double) { return packet_.stokes; });
        }
        if (!survives()) return false;
        const double azimuth = 2.0 * std::numbers::pi * random_.uniform();
        packet_.frame = meridian_frame(std::sqrt(random_.uniform()), std::cos(azimuth), std::sin(azimuth));
        return true;
    }

    // Makes s horizontal. A vertical ray may keep its frame: there every plane is a plane of incidence.
    void turn_to_meridian() {
        Frame& frame = packet_.frame;
        const double sine = std::hypot(frame.k.x(), frame.k.y());
        if (sine < 1e-10) return;
        const Frame meridian = meridian_frame(frame.k.z(), frame.k.x() / sine, frame.k.y() / sine);
        rotate(packet_.stokes, double_angle(meridian.p.dot(frame.p), meridian.p.dot(frame.s), 1.0));
        frame = meridian;
    }

    // Reflects or refracts the ray: new k_z, horizontal components times `ratio`, s kept.
    bool bend(double cosine, double ratio) {
        Frame& frame = packet_.frame;
        frame.k = Vector(ratio * frame.k.x(), ratio * frame.k.y(), cosine).normalized();
        frame.p = frame.k.cross(frame.s);
        return true;
    }

    const Stack& stack_;
    const std::vector<Cone>& cones_;
    RandomStream& random_;
    Sink& sink_;
    Packet<columns> packet_;
    double start_weight_ = 0.0;
};

}  // namespace patina::rt::monte_carlo
