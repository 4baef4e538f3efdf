#pragma once
// Where light begins: rays drawn from the lamps in proportion to their power, for the methods that follow light
// forward.

#include "patina/render/emitters.h"

namespace patina::render {

// A ray of light on its way.
struct EmittedRay {
    int emitter = -1;
    Vec3 position, direction;    // of travel
    Vec3 normal = Vec3::Zero();  // of the surface that shines
    SurfaceUv uv;                // likewise
    Float4 power;                // the ray's share of the flux: unpolarized
    // Densities, the choice of the emitter included in the first: per area of the surface, 1 for a point, per solid
    // angle for light from infinity (1 when parallel); then per solid angle, or per area across the ray from infinity.
    float origin_pdf = 0, ray_pdf = 0;
    bool delta_origin = false;  // nothing can hit this light by chance
    bool infinite = false;
};

class Emission {
  public:
    Emission(const Lights& lights, const Geometry& geometry);

    // False: no light this time.
    bool sample(const Wavelengths& w, float u, const Vec2& u_origin, const Vec2& u_ray, EmittedRay& ray) const;

    // The densities sample() has for light of a surface towards a direction, from where Lights::area_density() is
    // `area_density`, and for an environment's light that travels opposite to `to_infinity`.
    void surface_pdfs(int emitter, float cos, float area_density, float& origin_pdf, float& ray_pdf) const;
    void environment_pdfs(int emitter, const Vec3& to_infinity, float& origin_pdf, float& ray_pdf) const;
    // Likewise for a delta light that shines into `direction` of travel.
    void delta_pdfs(int emitter, float& origin_pdf, float& ray_pdf) const;

  private:
    const Lights& lights_;
    const Geometry& geometry_;
    DiscreteDistribution choice_;
};

}  // namespace patina::render
