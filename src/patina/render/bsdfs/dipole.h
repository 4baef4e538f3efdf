#pragma once
// Subsurface scattering as diffusion, `dipole`: a BSSDF. Light enters a smooth dielectric surface at one point, and
// leaves it at another, a distance r away, in proportion to
//
//   R_d(r) = alpha'/(4 pi) sum over z of z (1 + sigma_tr d) exp(-sigma_tr d) / d^3,   d^2 = r^2 + z^2,
//   z_r = 1/sigma_t',  z_v = z_r + 4 A D,  D = 1/(3 sigma_t'),  sigma_tr = sqrt(sigma_a / D),  A = (1 + F)/(1 - F)
//
// (Jensen, Marschner, Levoy & Hanrahan 2001, A practical model for subsurface light transport, eq. 4; F the share of
// diffuse light inside that the surface returns, integrated from Fresnel's equations). Its integral over the plane is
// alpha'/2 (exp(-sigma_tr z_r) + exp(-sigma_tr z_v)). Directions and polarization are those of `plastic`: by refraction
// on the way in and out, nothing kept between.
//
// `volumetric` follows the light from point to point; the other integrators let it leave where it entered, which is
// `plastic` with the same albedo. Limits: diffusion knows no single scattering, holds for sigma_a << sigma_s' and flat
// surfaces larger than 1/sigma_t', and misses the share that thin parts let through. tests/cross/dipole_test.cpp has
// the differences from a random walk.

#include "patina/render/bsdfs/plastic.h"

namespace patina::render {

// R_d of the path's wavelengths.
struct DipoleProfile {
    Float4 albedo;    // alpha', reduced
    Float4 z_r, z_v;  // depths of the sources
    Float4 sigma_tr;  // effective transport coefficient
    Float4 total;     // integral over the plane

    DipoleProfile(Float4 absorption, Float4 reduced_scattering, Float4 returned_inside);

    Float4 at(float r) const;  // per area
    // A radius with density 2 pi r R_d(r) / total of one wavelength, exactly; u in [0, 1).
    float sample_radius(int lane, float u) const;
};

struct Dipole : PlasticLayer {
    Spectrum absorption, reduced_scattering;  // per scene unit

    DipoleProfile profile(const Wavelengths& w) const {
        return {absorption.at(w), reduced_scattering.at(w), returned_inside.at(w)};
    }
    // Probability with which sample() takes the light from below the surface.
    float body_share(const Wavelengths& w, const Vec3& outgoing) const;
    // Light that leaves towards `outgoing` (local): its share, and polarization, of what arrives below the surface.
    void leave(const Wavelengths& w, const Vec3& outgoing, ScatteringMatrix& m) const;
    // Light that comes from `incident` and enters: per solid angle, times its cosine, all that enters adding up to 1.
    void enter(const Wavelengths& w, const Vec3& incident, ScatteringMatrix& m) const;

    static PluginDescriptor describe();
    static Dipole build(const Properties& node, const BsdfBuilder& builder);
};

}  // namespace patina::render
