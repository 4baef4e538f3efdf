#pragma once
// Light sources: a radiance per wavelength, and a state of polarization that the integrators apply where the light
// arrives (emitter_polarization.h, arriving_light.h).

#include <variant>
#include <vector>

#include "patina/render/bsdf.h"
#include "patina/render/emitter_polarization.h"
#include "patina/render/geometry.h"
#include "patina/render/lamp_table.h"
#include "patina/render/lamp_tree.h"
#include "patina/render/spectrum.h"
#include "patina/render/texture.h"

namespace patina::render {

// Light that arrives at a point from one direction.
struct LightSample {
    Vec3 direction;  // from the point to the light
    float distance = INFINITY;
    float pdf = 0;  // per solid angle; 1 for a delta light
    bool delta = false;
    Float4 radiance;  // radiance, or the irradiance on a plane across the direction for a delta light
    int emitter = -1;
    Vec3 normal = Vec3::Zero();  // of a surface that shines
    float area_density = 1;      // of the place on it, where 1 is uniform
};

// A surface that shines from its outside, `area`: the same radiance into every direction (Lambert's law), of each place
// its own where a texture says so. Points are drawn uniformly over the area, or where the table says it is bright.
struct AreaEmitter {
    int shape = -1;
    Texture radiance;
    std::shared_ptr<const LampTable> table;  // null: uniformly
};

// Intensity I into every direction from a point, `point`: irradiance I cos / r^2.
struct PointEmitter {
    Vec3 position;
    Spectrum intensity;
};

// Parallel light, `directional`: irradiance on a plane across it.
struct DirectionalEmitter {
    Vec3 direction;  // in which the light travels
    Spectrum irradiance;
};

// A picture in the way of a spot's light, or the slide of a projector.
struct Slide {
    Eigen::Matrix3f to_local;    // from the world; light travels along +z
    float tan_u = 1, tan_v = 1;  // half its width and height at distance 1, along the spot's x and y; < 0 mirrored
    Texture picture;
    // Of a projector: nothing passes beside the picture, whose colours are irradiance / pi on a plane across the axis
    // at distance 1 (Mitsuba's). Of a spot they are factors on its intensity.
    bool projects = false;

    Float4 at(const Wavelengths& w, const Vec3& direction) const;  // of travel
    float mean_factor() const;                                     // over the cone, for choosing between lights
};

// A cone of light, `spot`: intensity I inside beam_width, falling linearly in angle to 0 at the cutoff (Mitsuba's
// profile). A `projector` is one that is wide enough for its slide.
struct SpotEmitter {
    Vec3 position, axis;
    Spectrum intensity;
    float cutoff_rad = 0, beam_width_rad = 0;
    std::shared_ptr<const Slide> slide;  // null: none

    float falloff(const Vec3& direction) const;  // direction of travel, unit
    Float4 intensity_along(const Wavelengths& w, const Vec3& direction) const {
        const float share = falloff(direction);
        if (share <= 0) return splat(0);
        const Float4 plain = share * intensity.at(w);
        return slide ? plain * slide->at(w, direction) : plain;
    }
};

// The same radiance from everywhere, `constant`. Found by the paths that leave the scene, never sampled: no surface
// sees it better than its own scattering does.
struct ConstantEmitter {
    Spectrum radiance;
};

// Radiance from infinity given as a latitude-longitude picture, `envmap`. In the emitter's own axes y is up, u grows
// with the azimuth atan2(x, -z), v with the angle from +y (Mitsuba's). Colours are upsampled as emission: smooth
// spectrum x D65.
struct EnvironmentEmitter {
    int width = 0, height = 0;
    std::vector<std::array<float, 4>> texels;   // [y][x]: sigmoid coefficients and a scale
    Spectrum illuminant;                        // D65 of luminance 1 times the plugin's scale
    Eigen::Matrix3f to_local;                   // rotation from the world
    DiscreteDistribution rows;                  // by what a row sends, then
    std::vector<DiscreteDistribution> columns;  // by texel in the row

    Float4 radiance(const Wavelengths& w, const Vec3& direction) const;  // direction towards infinity
    float pdf(const Vec3& direction) const;
    void sample(const Vec2& u, Vec3& direction, float& pdf) const;
};

using Emitter =
    std::variant<AreaEmitter, PointEmitter, DirectionalEmitter, SpotEmitter, ConstantEmitter, EnvironmentEmitter>;

// Power on average over the visible range, into a scene of this size for light from infinity; for choosing between
// lights: only ratios matter.
float emitted_power(const Emitter& emitter, const Geometry& geometry);

class Lights {
  public:
    Lights() = default;
    // Emitters in the order of the scene, each with its state of polarization (none given: all unpolarized); the
    // geometry must be committed.
    Lights(std::vector<Emitter> emitters, const Geometry& geometry, std::vector<EmitterPolarization> states = {});

    // Draws a light and a direction to it; false: no light can be seen this way. The pdf includes the choice of the
    // light.
    bool sample(const Geometry& geometry, const Vec3& from, const Wavelengths& w, float u, const Vec2& u2,
                LightSample& sample) const;

    // The same of one emitter, its choice not in the pdf.
    bool sample_emitter(int emitter, const Geometry& geometry, const Vec3& from, const Wavelengths& w, const Vec2& u2,
                        LightSample& sample) const;
    // Points and parallel light: nothing meets them by chance.
    bool is_delta(int emitter) const;

    // Radiance that leaves a surface towards `outgoing` (world).
    Float4 surface_radiance(int emitter, const SurfacePoint& at, const Vec3& outgoing, const Wavelengths& w) const {
        if (outgoing.dot(at.geometric_normal) <= 0) return splat(0);
        return std::get<AreaEmitter>(emitters_[emitter]).radiance.at(w, at.uv);
    }
    // Density with which sample() finds a point of an emitting surface, per solid angle at `from`.
    float surface_pdf(int emitter, const Geometry& geometry, const Hit& hit, const SurfacePoint& at,
                      const Vec3& from) const {
        return choice_probability(emitter, from) * area_density(emitter, at.uv) * geometry.shape_pdf(hit, at, from);
    }
    // Density of the places of a surface that light is looked for at, where 1 is uniform.
    float area_density(int emitter, const SurfaceUv& uv) const {
        const auto& table = std::get<AreaEmitter>(emitters_[emitter]).table;
        return table ? table->density(uv) : 1.0f;
    }
    // Probability with which sample() chooses this emitter for a point.
    float choice_probability(int emitter, const Vec3& from) const {
        if (slot_[emitter] < 0) return 0;
        const float chosen = choice_.probability(slot_[emitter]);
        return lamp_[emitter] < 0 ? chosen : chosen * tree_.probability(lamp_[emitter], from);
    }
    const std::vector<int>& environments() const { return environments_; }
    // What comes from infinity: visit(radiance, density in sample() (0: never sampled), emitter).
    template <class Visitor>
    void for_each_environment(const Vec3& direction, const Wavelengths& w, const Visitor& visit) const {
        for (int index : environments_) {
            if (const auto* constant = std::get_if<ConstantEmitter>(&emitters_[index]))
                visit(constant->radiance.at(w), 0.0f, index);
            if (const auto* map = std::get_if<EnvironmentEmitter>(&emitters_[index]))
                visit(map->radiance(w, direction), choice_.probability(slot_[index]) * map->pdf(direction), index);
        }
    }
    bool any_sampled() const { return !sampled_.empty(); }
    // Does sample() need its first number?
    bool must_choose() const { return sampled_.size() > 1 || !lamps_.empty(); }

    bool any_polarized() const { return any_polarized_; }
    bool polarized(int emitter) const { return any_polarized_ && states_[emitter].polarized(); }
    // An emitter's light of this intensity on its way along `travel`.
    LightBeam beam(int emitter, Float4 intensity, const Vec3& travel) const {
        return polarized(emitter) ? states_[emitter].light(intensity, travel)
                                  : LightBeam::unpolarized(intensity, travel);
    }
    const std::vector<Emitter>& all() const { return emitters_; }

  private:
    void prepare_choice(const Geometry& geometry);

    std::vector<Emitter> emitters_;
    std::vector<EmitterPolarization> states_;  // of the emitters
    bool any_polarized_ = false;
    std::vector<int> environments_;  // emitters at infinity that paths run into
    // sample() chooses by power. Where lamps that are somewhere are many, all of them are one choice, and the tree
    // chooses among them; few are stratified better than they can be chosen.
    static constexpr int many_lamps = 17;
    DiscreteDistribution choice_;
    std::vector<int> sampled_;  // emitter of a choice, -1 for the lamps
    std::vector<int> slot_;     // choice that an emitter belongs to, -1 for none
    LampTree tree_;
    std::vector<int> lamps_;  // emitters of the tree
    std::vector<int> lamp_;   // of an emitter in the tree, -1 for none
};

// The emitter a plugin names (not `area`, which belongs to its shape).
Emitter build_emitter(const Properties& node, const SceneResources& resources);
Texture build_area_radiance(const Properties& node, const SceneResources& resources);

}  // namespace patina::render
