#pragma once
// A Mueller BRDF on half and difference angles, in the frames of Mitsuba 3's `measured_polarized`: what a .pbsdf file
// holds.
//
// i = towards the light, o = towards the viewer, z = outward normal. h = normalize(i + o), b = normalize(z x h),
// t = normalize(b x h), theta_h = acos(h.z), theta_d = acos(h.i), phi_d = atan2(b.i', t.i') with i' the part of i
// across h (Rusinkiewicz 1998). Stokes frames: x = normalize(i x o) for both rays, Q > 0 along x, U > 0 at +45 deg from
// x, right-handed about the direction of propagation, V > 0 clockwise for who looks into the source.

#include <span>
#include <vector>

#include "patina/brdf/mueller_table.h"

namespace patina::brdf {

struct HalfAngles {
    double theta_h = 0.0, theta_d = 0.0, phi_d = 0.0;  // radians
};

// Two directions away from the surface and the common x axis of their Stokes frames. `stokes_x` is along i x o and,
// where that vanishes (i = o, or i = -o), its limit at constant phi_d.
struct DirectionPair {
    Eigen::Vector3d i, o, stokes_x;
};
DirectionPair directions(const HalfAngles& angles);
HalfAngles half_angles(const Eigen::Vector3d& i, const Eigen::Vector3d& o);

// The bridge between the conventions: the same matrix for Stokes vectors in the solver's meridian frames and in frames
// with the x axis `pair.stokes_x`.
optics::Mueller to_half_angle_frames(const optics::Mueller& meridian, const DirectionPair& pair);
optics::Mueller to_meridian_frames(const optics::Mueller& half_angle, const DirectionPair& pair);

// The azimuth of the outgoing minus that of the incident propagation direction; a direction along the normal has
// azimuth 0.
double relative_azimuth(const DirectionPair& pair);

class HalfAngleTable {
  public:
    std::vector<double> theta_h, theta_d;  // radians, ascending within 0 .. pi/2, at least 2 each
    std::vector<double> phi_d;             // radians, ascending within -pi .. pi, both ends stored, at least 2
    std::vector<double> wavelengths_nm;    // ascending, at least 1
    std::vector<float> mueller;            // [phi_d][theta_d][theta_h][wavelength][4][4], 1/sr, no cosine

    // Throws Error(input) at `where` unless axes ascend in their ranges and the array fits them. NaN marks what was not
    // measured.
    void validate(const SourceLocation& where = {}) const;

    // Linear in the four axes, clamped; zero where a neighbour is NaN; f00 is not below 0. Frames of this table.
    optics::Mueller evaluate(double wavelength_nm, const HalfAngles& angles) const;

    // The same in the solver's convention: a BodyFunction.
    optics::Mueller evaluate_meridian(double wavelength_nm, double mu_o, double mu_i, double phi) const;
};

struct HalfAngleGrid {
    int theta_h = 64, theta_d = 46, phi_d = 73;
    std::vector<double> wavelengths_nm;  // whole nm; empty: five_wavelengths() of the table
};

// Five whole wavelengths, the number stock Mitsuba 3 reads: 450, 500, 550, 600, 650 nm where the table covers them,
// else equally spaced over the table's range.
std::vector<double> five_wavelengths(const MuellerTable& table);

// The body part of a table; the specular part is a delta function and has no place in such a grid. Nodes with a
// direction below the surface carry the value at the horizon, so that interpolation near it is not darkened.
HalfAngleTable to_half_angles(const MuellerTable& table, const HalfAngleGrid& grid = {});

}  // namespace patina::brdf
