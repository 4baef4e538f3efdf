#pragma once
// Optical elements in front of the camera, applied to a picture after the fact.

#include <Eigen/Dense>

#include "patina/core/stokes_image.h"

namespace patina::io {

// Mueller matrices in the convention of core/stokes_image.h; angles counter-clockwise from the picture's horizontal as
// the camera sees it.

// An ideal linear polarizer, transmission axis at `angle_deg`.
Eigen::Matrix4d polarizer_mueller(double angle_deg);

// An ideal retarder, fast axis at `fast_axis_deg`: 90 degrees of retardance make a quarter-wave plate. With the fast
// axis horizontal S2 > 0 becomes S3 < 0: the horizontal field then leads, which is left circular (Hecht 2017,
// section 8.7).
Eigen::Matrix4d retarder_mueller(double fast_axis_deg, double retardance_deg);

// Applies one matrix to every band of every pixel: an element without dispersion. The variance is dropped, for it would
// need the covariances of the components.
StokesImage apply_mueller(StokesImage image, const Eigen::Matrix4d& mueller);

}  // namespace patina::io
