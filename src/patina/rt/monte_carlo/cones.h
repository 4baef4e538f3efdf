#pragma once
// Directions of detection that share a level and a polar angle, and the local estimate of scattered light into them.

#include <vector>

#include "patina/rt/monte_carlo/stack.h"

namespace patina::rt::monte_carlo {

// All azimuths at one level, hemisphere and polar angle. An event at depth tau of a layer can be seen along two
// directions that end in the detected one without a further scattering: upward and downward, each with its gain.
class Cone {
  public:
    // `cosine` > 0 in the medium of the level.
    Cone(const Stack& stack, const SpecularStack::Level& level, double cosine);

    // Cosine in a layer, 0 if light from there cannot arrive unscattered.
    double mu(int layer) const { return layers_[static_cast<std::size_t>(layer)].mu; }

    // Detected radiance for unit radiance along mu(layer) from depth tau, going up or down.
    Gain gain(int layer, double tau, bool up) const {
        const LayerView& view = layers_[static_cast<std::size_t>(layer)];
        const Gain& at_face = up ? view.up_at_top : view.down_at_bottom;
        const bool detects = layer == level_.layer && up == level_.up && (up ? tau > level_.tau : tau < level_.tau);
        if (!detects && at_face.is_zero()) return {};
        Gain total = std::exp(-(up ? tau : view.thickness - tau) * view.inverse_mu) * at_face;
        if (detects) {
            const double direct = std::exp(-std::abs(tau - level_.tau) * view.inverse_mu);
            total = {total.pp + direct, total.ss + direct, total.cross + direct};
        }
        return total;
    }

    // Gain of radiance that leaves a rough top downward into layer 0, or upward out of the stack, and its cosine there
    // (0 when it is not detected).
    double mu_at_top(bool up) const { return !up ? mu(0) : level_.layer < 0 ? cosine_ : 0.0; }
    Gain gain_from_top(bool up) const {
        if (up) return {1.0, 1.0, 1.0};
        return gain(0, std::nextafter(0.0, -1.0), false);
    }

    // Radiance from a Lambertian base at the bottom of the last layer.
    Gain gain_from_base() const {
        const int last = static_cast<int>(layers_.size()) - 1;
        if (mu(last) == 0.0) return {};
        // The base lies below every level, also one at the very bottom.
        return gain(last, std::nextafter(layers_.back().thickness, INFINITY), true);
    }

  private:
    struct LayerView {
        double mu, inverse_mu, thickness;
        Gain up_at_top, down_at_bottom;
    };
    SpecularStack::Level level_;
    double cosine_;
    std::vector<LayerView> layers_;
};

// Stokes columns of light scattered from a packet's direction into the meridian frame of k = (sine cos, sine sin,
// cosine), without the factor 1/(4 pi).
template <int columns>
StokesColumns<columns> scatter_into(const Frame& frame, const StokesColumns<columns>& stokes,
                                    const ScatteringTable& table, double sine, double cosine, double cos_azimuth,
                                    double sin_azimuth) {
    // Components of the new direction in the packet's frame, and of the old one in the new frame.
    const auto horizontal = [&](const Vector& v) { return cos_azimuth * v.x() + sin_azimuth * v.y(); };
    const double along_k = horizontal(frame.k);
    const double x = sine * horizontal(frame.p) + cosine * frame.p.z();
    const double y = sine * horizontal(frame.s) + cosine * frame.s.z();
    const double cos_scatter = std::clamp(sine * along_k + cosine * frame.k.z(), -1.0, 1.0);
    const double old_p = cosine * along_k - sine * frame.k.z();
    const double old_s = sin_azimuth * frame.k.x() - cos_azimuth * frame.k.y();

    // Turn to the scattering plane, scatter, turn to the meridian plane. Exactly forward and backward any plane will
    // do.
    const double sin2 = x * x + y * y;
    StokesColumns<columns> out = stokes;
    DoubleAngle into{1.0, 0.0}, out_of{1.0, 0.0};
    if (sin2 > 1e-24) {
        into = double_angle(x, y, 1.0 / sin2);
        out_of = double_angle(-old_p, old_s, 1.0 / (old_p * old_p + old_s * old_s));
    } else {
        const Frame target = meridian_frame(cosine, cos_azimuth, sin_azimuth);
        out_of = double_angle(cos_scatter * target.p.dot(frame.p), target.p.dot(frame.s), 1.0);
    }
    rotate(out, into);
    apply(table.at(cos_scatter), out);
    rotate(out, out_of);
    return out;
}

}  // namespace patina::rt::monte_carlo
