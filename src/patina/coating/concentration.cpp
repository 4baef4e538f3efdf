#include "patina/coating/concentration.h"

#include "patina/core/contract.h"

namespace patina::coating {

namespace {

// Of a pigment that is not given by weight.
double own_fraction(const Concentration& pigment) {
    switch (pigment.kind) {
        case ConcentrationKind::pvc_percent:
            return 0.01 * pigment.value;
        case ConcentrationKind::number_density_um3:
            return pigment.value * pigment.mean_particle_volume_um3;
        default:
            return pigment.value;
    }
}

// Mass of a volume of film in g/cm^3.
double film_density(std::span<const Concentration> pigments, double binder_density) {
    double others_volume = 0.0, others_mass = 0.0, weight = 0.0, weight_volume = 0.0;
    for (const Concentration& pigment : pigments) {
        PATINA_EXPECT(pigment.density_g_cm3.has_value());
        if (pigment.kind == ConcentrationKind::weight_percent) {
            weight += 0.01 * pigment.value;
            weight_volume += 0.01 * pigment.value / *pigment.density_g_cm3;
        } else {
            others_volume += own_fraction(pigment);
            others_mass += own_fraction(pigment) * *pigment.density_g_cm3;
        }
    }
    PATINA_EXPECT(weight < 1.0 && others_volume <= 1.0);
    return (others_mass + binder_density * (1.0 - others_volume)) / (1.0 - weight + binder_density * weight_volume);
}

}  // namespace

std::vector<double> volume_fractions(std::span<const Concentration> pigments,
                                     std::optional<double> binder_density_g_cm3) {
    const bool by_weight = std::any_of(pigments.begin(), pigments.end(), [](const Concentration& pigment) {
        return pigment.kind == ConcentrationKind::weight_percent;
    });
    PATINA_EXPECT(!by_weight || binder_density_g_cm3.has_value());
    const double density = by_weight ? film_density(pigments, *binder_density_g_cm3) : 0.0;
    std::vector<double> fractions;
    for (const Concentration& pigment : pigments)
        fractions.push_back(pigment.kind == ConcentrationKind::weight_percent
                                ? 0.01 * pigment.value * density / *pigment.density_g_cm3
                                : own_fraction(pigment));
    return fractions;
}

}  // namespace patina::coating
