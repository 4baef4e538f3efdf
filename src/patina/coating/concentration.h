#pragma once
// How much of a pigment a layer holds, in the ways people say it, as volume fractions of the dry film.

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace patina::coating {

enum class ConcentrationKind {
    volume_fraction,     // volume of the particles / volume of the dry film
    pvc_percent,         // pigment volume concentration (ASTM D5146), 100 x the same in a film without voids
    weight_percent,      // 100 x mass of the particles / mass of the dry film
    number_density_um3,  // particles per um^3 of the dry film
};

struct Concentration {
    ConcentrationKind kind = ConcentrationKind::volume_fraction;
    double value = 0.0;
    double mean_particle_volume_um3 = 0.0;  // for number densities
    std::optional<double> density_g_cm3;    // of the pigment; needed as soon as one pigment is given by weight
};

// Volume fractions f of the pigments of one layer, in a film of pigments and binder without voids.
//
// With the mass m of a unit volume of film, a pigment given by weight w has f = w m / density; m is what the others,
// the binder in the volume that is left, and the pigments by weight themselves weigh: m (1 - sum w + binder_density sum
// w/density) = sum over the others of density f + binder_density (1 - sum of f). Preconditions: densities are there if
// any kind is weight_percent, weights add up to less than 100, the other fractions to at most 1.
std::vector<double> volume_fractions(std::span<const Concentration> pigments,
                                     std::optional<double> binder_density_g_cm3);

}  // namespace patina::coating
