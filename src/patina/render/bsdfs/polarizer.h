#pragma once
// Ideal thin polarization optics that light passes straight through: `polarizer` (linear), `retarder`, `circular`.
//
// Their axis is the surface's tangent (u direction) turned by theta about the normal. Collett (1992), ch. 5; Goldstein
// (2003), eq. 6-43 for the retarder (fast axis along x, phase delta). The element is the same from both sides; seen
// from behind the angle appears reversed because the observer is. Oblique light takes the axis projected across the
// ray, an idealization.

#include "patina/render/bsdf.h"
#include "patina/render/texture.h"

namespace patina::render {

struct PolarizationElement {
    enum class Kind { linear_polarizer, retarder, right_circular, left_circular };
    Kind kind;
    ScalarTexture theta_deg, delta_deg;  // delta of the retarder
    Texture transmittance;

    bool is_delta(const ShadingPoint&) const { return true; }
    bool evaluate(const ShadingPoint&, const Vec3&, const Vec3&, BsdfValue&) const { return false; }
    bool sample(const ShadingPoint& point, const Vec3& outgoing, float, const Vec2&, BsdfSample& sample) const;

  protected:
    static PolarizationElement common(Kind kind, const Properties& node, const BsdfBuilder& builder);
};

struct LinearPolarizer : PolarizationElement {
    static PluginDescriptor describe();
    static LinearPolarizer build(const Properties& node, const BsdfBuilder& builder);
};
struct Retarder : PolarizationElement {
    static PluginDescriptor describe();
    static Retarder build(const Properties& node, const BsdfBuilder& builder);
};
struct CircularPolarizer : PolarizationElement {
    static PluginDescriptor describe();
    static CircularPolarizer build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
