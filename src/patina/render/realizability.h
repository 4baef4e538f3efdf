#pragma once
// Is a Mueller matrix one of matter? It is if it is a sum of Jones matrices' (Cloude 1986): its coherency matrix has no
// negative eigenvalue. Products of such matrices are such matrices, so a path's throughput must be; a wrong frame or a
// wrong sign in one element makes one that is not. Looked at in debug builds (integrators/path.cpp).

#include "patina/render/mueller_packet.h"

namespace patina::render {

// Single precision leaves 1e-6 of element (0,0) for every event.
inline constexpr double event_tolerance = 1e-5, path_tolerance = 1e-3;

// The least eigenvalue is not below -tolerance times element (0,0), at every wavelength.
bool is_realizable(const ScatteringMatrix& event, double tolerance = event_tolerance);
bool is_realizable(const Throughput& path, double tolerance = path_tolerance);

// Did `event` take so much from `before` that what is left, `after`, is mostly rounding at some wavelength? As crossed
// polarizers do.
bool extinguishes(const ScatteringMatrix& event, const Throughput& before, const Throughput& after);

}  // namespace patina::render
