#pragma once
// Reflection and refraction by a surface of facets, each a smooth Fresnel mirror, as Mueller matrices between
// directions.

#include <complex>

#include "patina/optics/stokes.h"
#include "patina/rt/problem.h"

namespace patina::rt {

// Directions are propagation directions by cosine from the outward normal (negative is down) at azimuth 0 and phi. The
// facets lie between a medium of index `above` and one of index `below`, a metal when complex. Single scattering off
// the facets with the separable shadowing of Smith (Walter, Marschner, Li & Torrance 2007, Microfacet models for
// refraction, eqs 20, 21, 25-34), polarized as each facet's Fresnel matrix in its own plane of incidence.
class Microfacets {
  public:
    Microfacets(const RoughSurface& surface, std::complex<double> above, std::complex<double> below)
        : surface_(surface), above_(above), below_(below) {}

    // Radiance out per incident irradiance, 1/sr, divided by n_o/n_i when refracted: so defined, both ways of a path
    // are reciprocal. `only_mirrors` takes each facet for a perfect mirror.
    optics::Mueller operator()(double cos_i, double cos_o, double phi, bool only_mirrors = false) const;

    // Share of the light from a direction that a single facet reflects and no other stops.
    double reflectance(double cos_i) const;

  private:
    double density(double cos_h) const;
    double shadowing(double cosine) const;

    RoughSurface surface_;
    std::complex<double> above_, below_;
};

}  // namespace patina::rt
