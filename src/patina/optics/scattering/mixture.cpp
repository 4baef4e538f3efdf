#include "patina/optics/scattering/mixture.h"

#include <algorithm>
#include <cmath>

#include "patina/core/contract.h"
#include "patina/optics/scattering/expansion.h"

namespace patina::optics {

namespace {

ExpansionCoefficients isotropic() {
    return {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
}

}  // namespace

ScatteringMedium mix(std::span<const MixtureComponent> components) {
    ScatteringMedium medium;
    for (const MixtureComponent& c : components) {
        PATINA_EXPECT(c.number_density_per_um3 >= 0.0);
        medium.scattering_per_um += c.number_density_per_um3 * c.properties.scattering_um2;
        medium.absorption_per_um += c.number_density_per_um3 * c.properties.absorption_um2;
    }
    medium.extinction_per_um = medium.scattering_per_um + medium.absorption_per_um;
    if (medium.scattering_per_um <= 0.0) {
        medium.expansion = isotropic();
        return medium;
    }
    for (const MixtureComponent& c : components)
        add(medium.expansion, c.properties.expansion,
            c.number_density_per_um3 * c.properties.scattering_um2 / medium.scattering_per_um);
    return medium;
}

ScatteringProperties average(const ScatteringProperties& first, double first_weight, const ScatteringProperties& second,
                             double second_weight) {
    PATINA_EXPECT(first_weight >= 0.0 && second_weight >= 0.0 && std::abs(first_weight + second_weight - 1.0) < 1e-12);
    ScatteringProperties p;
    const auto both = [&](double a, double b) { return first_weight * a + second_weight * b; };
    p.extinction_um2 = both(first.extinction_um2, second.extinction_um2);
    p.scattering_um2 = both(first.scattering_um2, second.scattering_um2);
    p.absorption_um2 = both(first.absorption_um2, second.absorption_um2);
    p.mean_volume_um3 = both(first.mean_volume_um3, second.mean_volume_um3);
    // <r^3>/<r^2>, the second moment of each kind being <r^3>/r_eff.
    const double area =
        both(first.mean_volume_um3 / first.effective_radius_um, second.mean_volume_um3 / second.effective_radius_um);
    p.effective_radius_um = p.mean_volume_um3 / area;
    p.radii = first.radii + second.radii;
    p.quadrature_error = std::max(first.quadrature_error, second.quadrature_error);
    if (p.scattering_um2 <= 0.0) {
        p.expansion = isotropic();
        return p;
    }
    add(p.expansion, first.expansion, first_weight * first.scattering_um2 / p.scattering_um2);
    add(p.expansion, second.expansion, second_weight * second.scattering_um2 / p.scattering_um2);
    return p;
}

}  // namespace patina::optics
