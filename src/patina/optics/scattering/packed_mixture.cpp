#include "patina/optics/scattering/packed_mixture.h"

#include <algorithm>
#include <cmath>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/optics/scattering/expansion.h"
#include "patina/optics/scattering/structure_factor.h"

namespace patina::optics {

namespace {

// Number densities, lowered alike where the spheres would fill more than random close packing.
std::vector<double> possible_densities(std::span<const MixtureComponent> components) {
    double fraction = 0.0;
    for (const MixtureComponent& c : components) fraction += c.number_density_per_um3 * c.properties.mean_volume_um3;
    const double possible = fraction > max_packing_fraction ? max_packing_fraction / fraction : 1.0;
    std::vector<double> densities;
    for (const MixtureComponent& c : components) densities.push_back(possible * c.number_density_per_um3);
    return densities;
}

// Angles that resolve every F and the oscillations of the structure factors.
math::Quadrature angles_for(std::span<const MixtureComponent> components, double wavenumber, double largest_diameter) {
    int order = 0;
    for (const MixtureComponent& c : components) order = std::max(order, c.properties.expansion.order());
    return math::gauss_legendre(2 * (order + matrix_nodes(0.5 * wavenumber * largest_diameter)) + 2);
}

// What each kind's scattering at one angle is to be multiplied with: its own structure factor, and what interference
// with the other kinds makes of the sum. `strengths` are n C_sca a1 of the kinds.
Eigen::ArrayXd packing_factors(const Eigen::MatrixXd& structure, const Eigen::ArrayXd& strengths) {
    const Eigen::ArrayXd own = structure.diagonal();
    const Eigen::VectorXd amplitudes = strengths.sqrt();
    const double sum_of_own = (own * strengths).sum();
    return sum_of_own > 0.0 ? Eigen::ArrayXd(own * (amplitudes.dot(structure * amplitudes) / sum_of_own)) : own;
}

}  // namespace

void pack(std::span<MixtureComponent> components, double host_index, double wavelength_nm, double tolerance) {
    PATINA_EXPECT(!components.empty() && host_index > 0.0 && wavelength_nm > 0.0);
    const double wavenumber = 2.0 * pi * host_index / (1e-3 * wavelength_nm);
    const std::vector<double> densities = possible_densities(components);
    std::vector<double> diameters;
    for (const MixtureComponent& c : components)
        diameters.push_back(std::cbrt(6.0 * c.properties.mean_volume_um3 / pi));
    const math::Quadrature angles =
        angles_for(components, wavenumber, *std::max_element(diameters.begin(), diameters.end()));

    std::vector<ScatteringMatrix> matrices;
    for (const MixtureComponent& c : components) matrices.push_back(matrix_to_pack(c.properties.expansion, angles));

    const auto kinds = static_cast<Eigen::Index>(components.size());
    for (Eigen::Index angle = 0; angle < angles.size(); ++angle) {
        const double q = 2.0 * wavenumber * std::sqrt(0.5 * (1.0 - angles.nodes[angle]));
        Eigen::ArrayXd strengths(kinds);
        for (Eigen::Index k = 0; k < kinds; ++k)
            strengths[k] =
                components[k].number_density_per_um3 * components[k].properties.scattering_um2 * matrices[k].a1[angle];
        const Eigen::ArrayXd factors = packing_factors(percus_yevick_mixture(diameters, densities, q), strengths);
        for (Eigen::Index k = 0; k < kinds; ++k) {
            ScatteringMatrix& m = matrices[k];
            for (Eigen::ArrayXd* element : {&m.a1, &m.a2, &m.a3, &m.a4, &m.b1, &m.b2}) (*element)[angle] *= factors[k];
        }
    }

    for (Eigen::Index k = 0; k < kinds; ++k) {
        ScatteringProperties& properties = components[k].properties;
        if (!(properties.scattering_um2 > 0.0)) continue;
        properties.scattering_um2 *= normalize(matrices[k]);
        properties.extinction_um2 = properties.scattering_um2 + properties.absorption_um2;
        properties.expansion = expand(matrices[k], tolerance);
    }
}

}  // namespace patina::optics
