// Spheres in a host that absorbs.

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/math/quadrature.h"
#include "patina/optics/scattering/mie.h"
#include "patina/optics/scattering/particle_ensemble.h"

namespace patina::optics {
namespace {

using Complex = std::complex<double>;

struct Case {
    Complex particle, host;
    double radius_um, wavelength_um;
    double q_ext, q_sca;
};

MieSphere sphere_of(const Case& c) {
    const Complex x = 2 * pi * c.host * c.radius_um / c.wavelength_um;
    return MieSphere::in_absorbing_host(x, c.particle / c.host);
}

// The sums of Bohren & Huffman (1983), eqs 4.56-4.57, over Bessel functions of complex argument in 50-digit arithmetic.
TEST(AbsorbingHost, AgreesWithFiftyDigits) {
    const Case cases[] = {
        {2.7, {1.5, 0.02}, 0.125, 0.55, 3.9088509223865, 3.9646339378814},
        {{3.2, 0.5}, {1.5, 0.05}, 0.3, 0.5, 2.5649147749201, 1.411510223622},
        {1.33, {1.5, 0.01}, 5.0, 0.5, 1.6828118813327, 6.8966153180833},
        {2.7, {1.5, 0.05}, 0.01, 0.55, -0.0060586966973381, 0.00042545047134979},
        {{1.6, 0.001}, {1.4, 0.04}, 8.0, 0.5, -117.34307770607, 769022.90835051},
    };
    for (const Case& c : cases) {
        const MieSphere sphere = sphere_of(c);
        // Rounding, and the loss of exp(2 k'' r) = 3e3 where the host absorbs most.
        EXPECT_NEAR(sphere.extinction_efficiency(), c.q_ext, 1e-10 * std::max(std::abs(c.q_ext), c.q_sca));
        EXPECT_NEAR(sphere.scattering_efficiency(), c.q_sca, 1e-10 * c.q_sca);
        EXPECT_NEAR(sphere.absorption_efficiency(), c.q_ext - c.q_sca, 1e-10 * std::max(std::abs(c.q_ext), c.q_sca));
    }
}

// A hole that differs from its host in k alone takes away its volume of absorption, C_ext = -4 pi k V / lambda, and
// scatters nothing; the next order is relatively k (k' r).
TEST(AbsorbingHost, AHoleSubtractsItsVolumeOfTheHost) {
    for (const double k : {1e-4, 1e-3}) {
        const double r = 0.2, wavelength_um = 0.5;
        const ScatteringProperties hole = scatter(1.5, {1.5, k}, 500.0, {Monodisperse{r}});
        const double replaced = 4 * pi * k * hole.mean_volume_um3 / wavelength_um;
        EXPECT_NEAR(hole.extinction_um2, -replaced, 10 * k * replaced);
        EXPECT_LT(hole.scattering_um2, 10 * k * replaced);
    }
    const ScatteringProperties nothing = scatter({1.5, 0.02}, {1.5, 0.02}, 500.0, {Monodisperse{0.2}});
    EXPECT_NEAR(nothing.extinction_um2, 0.0, 1e-15);
    EXPECT_NEAR(nothing.scattering_um2, 0.0, 1e-15);
}

// Maxwell Garnett: dilute small spheres give the mixture the wavenumber k (1 + 3/2 f beta), beta = (e_p - e_h)/(e_p + 2
// e_h), so that C_ext = 3 V Im(k beta). This knows nothing of amplitudes, and fixes C_ext = 4 pi Re(S/k^2) against
// 4 pi Re(S)/|k|^2 or 4 pi Re(S/k)/k'.
TEST(AbsorbingHost, SmallSpheresGiveTheMixtureOfMaxwellGarnett) {
    const Complex host(1.5, 0.05), particle(2.7, 0.0);
    const double r = 1e-3, wavelength_um = 0.55;
    const Complex k = 2 * pi * host / wavelength_um;
    const Complex beta = (particle * particle - host * host) / (particle * particle + 2.0 * host * host);
    const ScatteringProperties p = scatter(particle, host, 1e3 * wavelength_um, {Monodisperse{r}});
    // Corrections of the order x^2 = 3e-4.
    EXPECT_NEAR(p.extinction_um2 / (3 * p.mean_volume_um3 * (k * beta).imag()), 1.0, 1e-3);
}

// Cross sections go to those of the clear host linearly in k.
TEST(AbsorbingHost, AWeaklyAbsorbingHostIsNearlyClear) {
    const SizeDistribution sizes{LogNormal{0.125, 1.3}};
    const ScatteringOptions options{.tolerance = 1e-4};
    const auto at = [&](double k) { return scatter(2.7, {1.5, k}, 550.0, sizes, options); };
    const ScatteringProperties clear = at(0.0), faint = at(1e-5), strong = at(1e-4);
    EXPECT_NEAR((strong.extinction_um2 - clear.extinction_um2) / (faint.extinction_um2 - clear.extinction_um2), 10.0,
                0.02);
    EXPECT_NEAR(at(1e-9).extinction_um2, clear.extinction_um2, 1e-8 * clear.extinction_um2);
    EXPECT_NEAR(at(1e-9).expansion.alpha1[1], clear.expansion.alpha1[1], 1e-7);
}

// C_sca is the integral of |S|^2 / |k|^2 over all directions.
TEST(AbsorbingHost, ScatteringIsTheIntegralOfTheAmplitudes) {
    const Complex x(6.0, 0.3);
    const MieSphere sphere = MieSphere::in_absorbing_host(x, Complex(2.7, 0.0) / Complex(1.5, 0.075));
    const math::Quadrature rule = math::gauss_legendre(60);
    const MieAmplitudes s = sphere.amplitudes(rule.nodes);
    double sum = 0.0;
    for (int i = 0; i < rule.size(); ++i) sum += rule.weights[i] * (std::norm(s.s1[i]) + std::norm(s.s2[i]));
    EXPECT_NEAR(sum / std::norm(x), sphere.scattering_efficiency(), 1e-12 * sphere.scattering_efficiency());
}

TEST(AbsorbingHost, RefusesWhatItCannotDo) {
    EXPECT_THROW(scatter(2.7, {1.5, 0.05}, 500.0, {Monodisperse{10.0}}), Error);
    EXPECT_THROW(scatter(2.7, {1.5, -1e-3}, 500.0, {Monodisperse{0.1}}), Error);
    EXPECT_THROW(scatter(2.7, {1.5, 2.0}, 500.0, {Monodisperse{0.01}}), Error);
}

}  // namespace
}  // namespace patina::optics
