#include "patina/optics/scattering/external_particles.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/optics/scattering/expansion.h"
#include "patina/optics/scattering/mixture.h"
#include "patina/optics/scattering/structure_factor.h"

namespace patina::optics {

namespace {

// Nothing is truncated that was given.
constexpr double kept_coefficients = 1e-12;

template <class Entry>
bool covers(const std::vector<Entry>& entries, double wavelength_nm) {
    return entries.front().wavelength_nm == 0.0 ||
           (wavelength_nm >= entries.front().wavelength_nm && wavelength_nm <= entries.back().wavelength_nm);
}

// The two neighbours of a wavelength and the weight of the second.
template <class Entry>
struct Neighbours {
    const Entry& first;
    const Entry& second;
    double weight;
};

template <class Entry>
Neighbours<Entry> neighbours(const std::vector<Entry>& entries, double wavelength_nm) {
    PATINA_EXPECT(!entries.empty());
    const auto above = std::lower_bound(entries.begin(), entries.end(), wavelength_nm,
                                        [](const Entry& entry, double nm) { return entry.wavelength_nm < nm; });
    if (above == entries.begin()) return {entries.front(), entries.front(), 0.0};
    if (above == entries.end()) return {entries.back(), entries.back(), 0.0};
    const Entry& below = *(above - 1);
    return {below, *above, (wavelength_nm - below.wavelength_nm) / (above->wavelength_nm - below.wavelength_nm)};
}

}  // namespace

bool covers(const ExternalParticles& particles, double wavelength_nm) {
    return covers(particles.laws, wavelength_nm) && covers(particles.cross_sections, wavelength_nm);
}

ScatteringProperties scatter(const ExternalParticles& particles, double wavelength_nm, Extrapolation extrapolation) {
    if (!covers(particles, wavelength_nm) && extrapolation == Extrapolation::refuse)
        throw input_error({}, fmt::format("no scattering by {} at {} nm", particles.name, wavelength_nm),
                          "its files give other wavelengths",
                          "stay inside theirs, ask for extrapolation, or bring other data");
    const auto cross = neighbours(particles.cross_sections, wavelength_nm);
    const auto law = neighbours(particles.laws, wavelength_nm);
    const auto between = [](double a, double b, double weight) { return (1.0 - weight) * a + weight * b; };

    ScatteringProperties properties;
    properties.extinction_um2 = between(cross.first.extinction_um2, cross.second.extinction_um2, cross.weight);
    properties.scattering_um2 = between(cross.first.scattering_um2, cross.second.scattering_um2, cross.weight);
    properties.absorption_um2 = std::max(0.0, properties.extinction_um2 - properties.scattering_um2);
    properties.mean_volume_um3 = particles.volume_um3;
    properties.effective_radius_um = std::cbrt(0.75 * particles.volume_um3 / pi);
    add(properties.expansion, law.first.expansion, 1.0 - law.weight);
    if (law.weight > 0.0) add(properties.expansion, law.second.expansion, law.weight);
    truncate(properties.expansion, kept_coefficients);
    return properties;
}

ScatteringProperties pack(const ScatteringProperties& particles, double packing_fraction, double host_index,
                          double wavelength_nm) {
    PATINA_EXPECT(packing_fraction >= 0.0 && host_index > 0.0);
    ScatteringProperties packed = particles;
    if (packing_fraction == 0.0 || particles.scattering_um2 <= 0.0) return packed;

    // F at angles that resolve it and the oscillations of the structure factor.
    const double wavenumber = 2.0 * pi * host_index / (1e-3 * wavelength_nm);
    const double diameter = std::cbrt(6.0 * particles.mean_volume_um3 / pi);
    const int nodes = 2 * (particles.expansion.order() + matrix_nodes(0.5 * wavenumber * diameter)) + 2;
    ScatteringMatrix matrix = matrix_to_pack(particles.expansion, math::gauss_legendre(nodes));
    packed.scattering_um2 *= apply_structure_factor(matrix, packing_fraction, wavenumber, diameter);
    packed.extinction_um2 = packed.scattering_um2 + particles.absorption_um2;
    packed.expansion = expand(matrix, 1e-9);
    return packed;
}

}  // namespace patina::optics
