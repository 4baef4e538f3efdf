#pragma once
// The frame in which the solver's Stokes vectors live, as vectors in space (docs/conventions.md).

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace patina::brdf {

// z is the outward normal; `propagation` is where the light goes. s x p = propagation (Bohren & Huffman 1983), p in the
// meridian plane, so that Q > 0 along p and U > 0 along p + s.
struct MeridianFrame {
    Eigen::Vector3d p, s, propagation;
};

// Light travelling at the cosine `cos_polar` from the outward normal, -1 .. 1, and an azimuth in radians. At the poles
// the azimuth still tells the meridian plane.
inline MeridianFrame meridian_frame(double cos_polar, double azimuth) {
    const double sine = std::sqrt(std::max(0.0, 1 - cos_polar * cos_polar));
    MeridianFrame frame;
    frame.propagation = {sine * std::cos(azimuth), sine * std::sin(azimuth), cos_polar};
    frame.s = {-std::sin(azimuth), std::cos(azimuth), 0.0};
    frame.p = frame.propagation.cross(frame.s);
    return frame;
}

}  // namespace patina::brdf
