#pragma once
// Where light that leaves a translucent body entered it: points of the surface drawn by a BSSDF's profile.
//
// King, Kulla, Conty & Fajardo (2013), BSSRDF importance sampling: a disk around the point, across the normal or one of
// two tangents, a radius from the profile, and a line through the disk that meets the surface. All three axes and all
// wavelengths, by which a point may have been found, share its density (balance heuristic). Lines reach as far as the
// profile does; only points of the same shape count.

#include "patina/render/bsdfs/dipole.h"
#include "patina/render/geometry.h"

namespace patina::render {

struct SubsurfaceEntry {
    SurfacePoint point;
    Float4 weight;  // profile over density
};

// `time` is the moment that the path sees. `share`: with which probability each wavelength's profile is drawn from.
// False: none is found this time.
bool sample_subsurface(const Geometry& geometry, const DipoleProfile& profile, const SurfacePoint& from, Float4 share,
                       float u_axis, const Vec2& u_disk, float u_hit, SubsurfaceEntry& entry, float time = 0);

}  // namespace patina::render
