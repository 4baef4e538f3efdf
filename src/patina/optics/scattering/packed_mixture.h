#pragma once
// Interference between densely packed particles of several kinds.

#include <span>

#include "patina/optics/scattering/mixture.h"

namespace patina::optics {

// Takes the interference of all particles of a layer into account, each kind as equal hard spheres of its mean volume
// (percus_yevick_mixture): between coarse particles fine ones crowd into what room is left, but coarse ones do not
// order them as neighbours of their own size would. Amplitudes of different kinds are taken to be in phase, which is
// exact for equal particles and in Rayleigh-Gans scattering; between unlike sizes they matter in the forward peak
// alone. The properties become those of a packed particle of each kind, so that mix() adds up to the layer. More
// particles than can be packed at random are held there. `tolerance` as in ScatteringOptions.
void pack(std::span<MixtureComponent> components, double host_index, double wavelength_nm, double tolerance);

}  // namespace patina::optics
