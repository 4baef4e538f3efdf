#include "patina/optics/scattering/packed_mixture.h"

#include <algorithm>
#include <cmath>

#include "patina/core/constants.h"
#include "patina/optics/scattering/structure_factor.h"

namespace patina::optics {
namespace {

constexpr double host = 1.5, wavelength_nm = 550.0, tolerance = 1e-6;

double volume(double diameter) {
    return pi / 6.0 * diameter * diameter * diameter;
}

MixtureComponent spheres(double index, double radius_um, double volume_fraction) {
    MixtureComponent component;
    component.properties = scatter(index, host, wavelength_nm, {Monodisperse{radius_um}}, {.tolerance = tolerance});
    component.number_density_per_um3 = volume_fraction / component.properties.mean_volume_um3;
    return component;
}

double transport(const ScatteringProperties& p) {
    return p.scattering_um2 * (1.0 - p.asymmetry());
}

TEST(PercusYevickMixture, OfEqualSpheresIsThatOfOneKind) {
    const std::vector<double> diameters = {0.24, 0.24};
    const std::vector<double> densities = {0.1 / volume(0.24), 0.2 / volume(0.24)};
    const Eigen::Vector2d amplitudes(std::sqrt(densities[0]), std::sqrt(densities[1]));
    // Rounding, magnified by the cancellation of 1/S(0) ~ 30; near q d = 0 by that of the closed form.
    for (const double q : {0.0, 1e-3, 0.3, 2.0, 8.0, 15.0, 100.0})
        EXPECT_NEAR(
            amplitudes.dot(percus_yevick_mixture(diameters, densities, q) * amplitudes) / (densities[0] + densities[1]),
            percus_yevick(0.3, q * 0.24), 1e-10)
            << q;
}

// Pressure over kT of a mixture (Lebowitz 1964, Phys. Rev. 133, A895, by the compressibility).
double pressure(const std::vector<double>& d, const std::vector<double>& n) {
    double xi[4] = {};
    for (int k = 0; k < 4; ++k)
        for (std::size_t i = 0; i < d.size(); ++i) xi[k] += pi / 6.0 * n[i] * std::pow(d[i], k);
    const double free = 1.0 - xi[3];
    return 6.0 / pi * (xi[0] / free + 3.0 * xi[1] * xi[2] / std::pow(free, 2) + 3.0 * std::pow(xi[2] / free, 3));
}

// sum_i sqrt(n_i / n_j) (S^-1(0))_ij = d(P/kT)/dn_j (Kirkwood & Buff 1951).
TEST(PercusYevickMixture, HasTheCompressibilityOfTheMixture) {
    const std::vector<double> d = {0.2, 0.35, 1.0};
    const std::vector<double> n = {0.1 / volume(0.2), 0.07 / volume(0.35), 0.15 / volume(1.0)};
    const Eigen::MatrixXd inverse = percus_yevick_mixture(d, n, 0.0).inverse();
    for (int j = 0; j < 3; ++j) {
        double sum = 0.0;
        for (int i = 0; i < 3; ++i) sum += std::sqrt(n[i] / n[j]) * inverse(i, j);
        std::vector<double> more = n, less = n;
        const double step = 1e-4 * n[j];  // central differences err by its square
        more[j] += step, less[j] -= step;
        EXPECT_NEAR(sum / ((pressure(d, more) - pressure(d, less)) / (2.0 * step)), 1.0, 1e-6) << j;
    }
}

// Between coarse particles fine ones have the room that is left: f / (1 - F). What the holes scatter besides falls with
// q^4 (Porod 1951) and is 6e-4 at q d = 200.
TEST(PercusYevickMixture, FineSpheresBetweenCoarseOnesHaveTheRoomThatIsLeft) {
    const double fine = 0.2, coarse = 10.0;
    const std::vector<double> densities = {0.12 / volume(fine), 0.25 / volume(coarse)};
    for (const double q : {20.0, 30.0, 40.0})
        EXPECT_NEAR(percus_yevick_mixture(std::vector<double>{fine, coarse}, densities, q)(0, 0),
                    percus_yevick(0.12 / 0.75, q * fine), 0.01)
            << q;
}

// What is one pigment to one is two halves to another.
TEST(PackedMixture, OfTwoHalvesIsTheWhole) {
    std::vector<MixtureComponent> whole = {spheres(2.7, 0.12, 0.2)};
    std::vector<MixtureComponent> halves = {spheres(2.7, 0.12, 0.15), spheres(2.7, 0.12, 0.05)};
    pack(whole, host, wavelength_nm, tolerance);
    pack(halves, host, wavelength_nm, tolerance);
    const ScatteringMedium one = mix(whole), two = mix(halves);
    EXPECT_NEAR(two.scattering_per_um / one.scattering_per_um, 1.0, 1e-10);
    // Each half is cut off where its own coefficients fall below the tolerance.
    for (int l = 0; l <= std::min(one.expansion.order(), two.expansion.order()); ++l)
        EXPECT_NEAR(two.expansion.alpha1[l], one.expansion.alpha1[l], tolerance);

    // And the same as the structure factor of one kind gives.
    const ScatteringProperties alone =
        scatter(2.7, host, wavelength_nm, {Monodisperse{0.12}}, {.tolerance = tolerance, .packing_fraction = 0.2});
    EXPECT_NEAR(whole[0].properties.scattering_um2 / alone.scattering_um2, 1.0, 10 * tolerance);
}

// A coarse extender without contrast takes room away from the pigment, and orders it less than more pigment would.
TEST(PackedMixture, ACoarseExtenderCrowdsThePigmentIntoTheRestOfTheBinder) {
    std::vector<MixtureComponent> paint = {spheres(2.7, 0.1, 0.12), spheres(1.5, 2.0, 0.25)};
    pack(paint, host, wavelength_nm, tolerance);
    const auto pigment_at = [](double fraction) {
        return transport(scatter(2.7, host, wavelength_nm, {Monodisperse{0.1}},
                                 {.tolerance = tolerance, .packing_fraction = fraction}));
    };
    const double found = transport(paint[0].properties);
    EXPECT_LT(found, pigment_at(0.12));
    EXPECT_GT(found, pigment_at(0.37));
    // In the limit of a coarse extender; 20 times the pigment's size is within three per cent of it.
    EXPECT_NEAR(found / pigment_at(0.12 / 0.75), 1.0, 0.03);
}

}  // namespace
}  // namespace patina::optics
