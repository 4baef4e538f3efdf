#pragma once
// A rough interface on top of the stack as the random walk meets it: a facet is drawn, reflects or refracts by
// electric-field amplitudes in its own plane of incidence, and what another facet stops leaves without polarization.
//
// The law is that of docs/theory_rough_and_truncation.md (facets of Smith with separable shadowing, light that meets
// several of them spread over both sides in proportion to what each direction loses), written down a second time in
// ray space: no Fourier orders, no quadrature rays, no balancing.

#include <vector>

#include "patina/rt/monte_carlo/interface.h"
#include "patina/rt/monte_carlo/random.h"
#include "patina/rt/problem.h"

namespace patina::rt::monte_carlo {

class RoughTop {
  public:
    RoughTop(const RoughSurface& surface, double above, double below, bool scalar);

    // Stokes columns of radiance along k_out, in its meridian frame, per unit of flux through the horizontal that
    // arrives in a frame with the given Stokes columns.
    template <int columns>
    StokesColumns<columns> radiance(const Frame& frame, const StokesColumns<columns>& stokes,
                                    const Vector& k_out) const {
        const Facet facet = facet_between(frame.k, k_out);
        StokesColumns<columns> result = StokesColumns<columns>::Zero();
        if (facet.factor > 0.0) {
            result = stokes;
            const Frame out = act(facet, frame, k_out, result);
            const double sine = std::hypot(k_out.x(), k_out.y());
            const Frame meridian = sine > 0.0 ? meridian_frame(k_out.z(), k_out.x() / sine, k_out.y() / sine)
                                              : meridian_frame(k_out.z(), 1.0, 0.0);
            rotate(result, double_angle(meridian.p.dot(out.p), meridian.p.dot(out.s), 1.0));
            result *= facet.factor;
        }

        // What the facets lose of I and Q in the meridian frame, given back.
        const double index = k_out.z() > 0.0 ? above_ : below_, sine = std::hypot(frame.k.x(), frame.k.y());
        const Loss in = lost(frame.k.z()), out = lost(-k_out.z());
        DoubleAngle turn{1.0, 0.0};
        if (sine > 1e-10) {
            const Frame meridian = meridian_frame(frame.k.z(), frame.k.x() / sine, frame.k.y() / sine);
            turn = double_angle(meridian.p.dot(frame.p), meridian.p.dot(frame.s), 1.0);
        }
        const Eigen::Matrix<double, 1, columns> stopped =
            index * index / lost_total_ *
            (in.i * stokes.row(0) + in.q * (turn.cosine * stokes.row(1) + turn.sine * stokes.row(2)));
        result.row(0) += out.i * stopped;
        result.row(1) += out.q * stopped;
        return result;
    }

    // Draws where a packet goes on: new frame and Stokes columns, and the weight to multiply; 0 ends it.
    template <int columns>
    double draw(Frame& frame, StokesColumns<columns>& stokes, RandomStream& random) const {
        Vector normal = draw_normal(random);
        if (frame.k.z() > 0.0) normal = -normal;
        const double cosine = std::min(1.0, -frame.k.dot(normal)), up = std::abs(frame.k.z());
        if (cosine <= 0.0 || up == 0.0) return 0.0;
        const double weight = unshadowed(up) * cosine / (up * std::abs(normal.z()));

        // Reflect or refract by the packet's own polarization.
        const bool from_above = frame.k.z() < 0.0;
        const double n_i = from_above ? above_ : below_, n_t = from_above ? below_ : above_;
        const InterfaceGains gains = interface(cosine, n_i, n_t);
        Facet facet{normal, gains.reflect, 1.0};
        StokesColumns<columns> out = stokes;
        Vector k = frame.k + 2.0 * cosine * normal;
        Frame turned = act(facet, frame, k, out);
        double chance = std::clamp(out(0, 0) / stokes(0, 0), 0.0, 1.0);
        const bool reflects = gains.cos_t == 0.0 || random.uniform() < chance;
        if (!reflects) {
            facet.gain = gains.transmit;
            out = stokes;
            k = n_i / n_t * frame.k + (n_i / n_t * cosine - gains.cos_t) * normal;
            turned = act(facet, frame, k, out);
            chance = 1.0 - chance;
        } else if (gains.cos_t == 0.0) {
            chance = 1.0;
        }
        if (!(chance > 0.0)) return 0.0;
        out /= chance;

        // Another facet may stop it.
        const bool right_side = (k.z() > 0.0) == (reflects == from_above);
        if (!right_side || random.uniform() >= unshadowed(std::abs(k.z()))) {
            turned = draw_lost(random);
            const Loss loss = lost(-turned.k.z());
            out.template bottomRows<3>().setZero();
            out.row(1) = loss.q / loss.i * out.row(0);
        }
        frame = turned;
        stokes = out;
        return weight;
    }

  private:
    struct Facet {
        Vector normal;  // towards the side the light comes from
        Gain gain;
        double factor;  // radiance per flux; 0 where no facet leads from one direction to the other
    };
    InterfaceGains interface(double cos_i, double n1, double n2) const;
    Facet facet_between(const Vector& k_in, const Vector& k_out) const;
    double density(double cos_h) const;
    double unshadowed(double cosine) const;
    Vector draw_normal(RandomStream& random) const;
    Frame draw_lost(RandomStream& random) const;
    // What of the I and Q of a direction of incidence, by its vertical cosine, leaves no facet freely: I - E_I, -E_Q
    // with E the albedo. By reciprocity also the Stokes vector of what leaves the other way after several facets.
    struct Loss {
        double i, q;
    };
    Loss lost(double k_z) const;
    Loss integrate_lost(double k_z) const;

    // Turns Stokes columns into the facet's plane of incidence and applies its gain; the frame of the new direction.
    template <int columns>
    Frame act(const Facet& facet, const Frame& frame, const Vector& k_out, StokesColumns<columns>& stokes) const {
        const Vector across = frame.k.cross(facet.normal);
        const double sine = across.norm();
        const Vector s = sine > 1e-10 ? Vector(across / sine) : frame.s;
        const Vector p = frame.k.cross(s);
        rotate(stokes, double_angle(p.dot(frame.p), p.dot(frame.s), 1.0));
        apply(facet.gain, stokes);
        return {k_out, k_out.cross(s), s};
    }

    RoughSurface surface_;
    double above_, below_;
    bool scalar_;
    std::vector<Loss> lost_above_, lost_below_;  // of light from above and below, at equidistant cosines
    double lost_total_ = 1.0, lost_share_above_ = 0.5;
};

}  // namespace patina::rt::monte_carlo
