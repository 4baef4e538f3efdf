#include "patina/optics/scattering/particle_ensemble.h"

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/optics/scattering/expansion.h"
#include "patina/optics/scattering/mie.h"
#include "patina/optics/scattering/mixture.h"

namespace patina::optics {
namespace {

using Complex = std::complex<double>;

TEST(ParticleEnsemble, MonodisperseIsTheSphereItself) {
    const double wavelength_um = 0.55, host = 1.495, r = 0.3;
    for (Complex m : {Complex(2.75), Complex(3.19, 0.48), Complex(0.423, 2.48), Complex(1.3)}) {
        const ScatteringProperties p = scatter(m, host, 1e3 * wavelength_um, {Monodisperse{r}}, {.tolerance = 1e-10});
        const double x = 2 * pi * host * r / wavelength_um, area = pi * r * r;
        const MieSphere sphere(x, m / host);
        EXPECT_NEAR(p.extinction_um2, area * sphere.extinction_efficiency(), 1e-14);
        EXPECT_NEAR(p.scattering_um2, area * sphere.scattering_efficiency(), 1e-14);
        EXPECT_NEAR(p.absorption_um2, area * sphere.absorption_efficiency(), 1e-14);
        EXPECT_NEAR(p.asymmetry(), sphere.asymmetry(), 1e-10);
        EXPECT_NEAR(p.mean_volume_um3, 4.0 / 3.0 * pi * r * r * r, 1e-15);
        EXPECT_EQ(p.radii, 1);

        // F from the amplitudes, times 4 pi/(k^2 C_sca) = 4/(x^2 Q_sca).
        for (double cosine : {-1.0, -0.6, 0.0, 0.1, 0.8, 1.0}) {
            const MieAmplitudes s = sphere.amplitudes(std::span(&cosine, 1));
            const Complex s1 = s.s1[0], s2 = s.s2[0], cross = s2 * std::conj(s1);
            const double factor = 4 / (x * x * sphere.scattering_efficiency());
            const ScatteringElements f = evaluate(p.expansion, cosine);
            // Dropped orders: 1e-10 each.
            EXPECT_NEAR(f.a1, factor * 0.5 * (std::norm(s1) + std::norm(s2)), 1e-8);
            EXPECT_NEAR(f.b1, factor * 0.5 * (std::norm(s2) - std::norm(s1)), 1e-8);
            EXPECT_NEAR(f.a3, factor * cross.real(), 1e-8);
            EXPECT_NEAR(f.b2, factor * cross.imag(), 1e-8);
        }
    }
}

// The particles of a polarized Monte Carlo reference: log-normal, 0.125 um, 1.3, index 2.75 in 1.495, 550 nm; six
// digits.
TEST(ParticleEnsemble, TitaniaOfTheMonteCarloReference) {
    const ScatteringProperties p = scatter(2.75, 1.495, 550, {LogNormal{0.125, 1.3}});
    EXPECT_NEAR(p.extinction_um2, 0.222813, 6e-7);
    // Its 512 size classes left 1e-6 in g (0.5393215 with 8192 radii).
    EXPECT_NEAR(p.asymmetry(), 0.539322, 1.1e-6);
    EXPECT_EQ(p.absorption_um2, 0.0);
    EXPECT_NEAR(p.mean_volume_um3 / mean_volume_um3({LogNormal{0.125, 1.3}}), 1.0, 1e-5);
}

// Orders an independent prototype needed at 1e-6 for sigma_g 1.3 at 550 nm: 9, 16, 18, 28, 72. Counting every
// coefficient above 1e-6 takes up to two more.
TEST(ParticleEnsemble, OrderOfTheExpansionGrowsWithSize) {
    constexpr std::pair<double, int> orders[] = {{0.05, 9}, {0.1, 16}, {0.125, 18}, {0.2, 28}, {0.5, 72}};
    for (auto [r, order] : orders) {
        const ScatteringProperties p =
            scatter(2.75, 1.495, 550, {LogNormal{r, 1.3}}, {.tolerance = 1e-6, .max_radii = 1100});
        EXPECT_GE(p.expansion.order(), order) << r;
        EXPECT_LE(p.expansion.order(), order + 2) << r;
    }
}

// The error estimate bounds the error against a far finer average, resonances included.
TEST(ParticleEnsemble, KeepsItsTolerance) {
    for (auto [m, r, sigma] : {std::tuple{Complex(2.75), 0.125, 1.3},
                               {Complex(2.75), 0.2, 1.3},
                               {Complex(3.19, 0.48), 0.2, 1.5},
                               {Complex(0.423, 2.48), 0.05, 1.2}}) {
        const SizeDistribution d{LogNormal{r, sigma}};
        const ScatteringProperties reference = scatter(m, 1.495, 550, d, {.tolerance = 1e-8, .max_radii = 9000});
        for (double tolerance : {1e-2, 1e-3, 1e-4}) {
            const ScatteringProperties p = scatter(m, 1.495, 550, d, {.tolerance = tolerance});
            EXPECT_LE(p.quadrature_error, tolerance);
            EXPECT_NEAR(p.extinction_um2 / reference.extinction_um2, 1.0, tolerance) << m << r;
            EXPECT_NEAR(p.asymmetry(), reference.asymmetry(), tolerance) << m << r;
            for (int l = 0; l <= p.expansion.order(); ++l)
                EXPECT_NEAR(p.expansion.alpha1[l], reference.expansion.alpha1[l], tolerance * (2 * l + 1)) << m << r;
        }
    }
}

// Small absorbing particles absorb by their volume, whatever the distribution (Rayleigh): C_abs/V = 3 k
// Im((m^2-1)/(m^2+2)).
TEST(ParticleEnsemble, VolumeAbsorptionDoesNotDependOnTheDistribution) {
    const Complex m(1.5, 0.1);
    const double wavelength_um = 100.0;
    const double expected = 3 * 2 * pi / wavelength_um * ((m * m - 1.0) / (m * m + 2.0)).imag();
    for (const SizeDistribution& d :
         {SizeDistribution{LogNormal{1e-3, 1.4}}, SizeDistribution{LogNormal{1e-3, 1.4}, SizeWeighting::volume},
          SizeDistribution{Gamma{1e-3, 0.2}}, SizeDistribution{ModifiedGamma{2, 1, 1e-3}},
          SizeDistribution{PowerLaw{3.5, 1e-4, 1e-2}}, SizeDistribution{RosinRammler{1e-3, 0.9}, SizeWeighting::volume},
          SizeDistribution{Histogram{{1e-4, 1e-3, 2e-3}, {1, 2}}}}) {
        const ScatteringProperties p = scatter(m, 1.0, 1e3 * wavelength_um, d, {.tolerance = 1e-6});
        // Corrections of the order of x^2 < 1e-6, and the tolerance.
        EXPECT_NEAR(p.absorption_um2 / p.mean_volume_um3 / expected, 1.0, 3e-6) << d.shape.index();
    }
}

TEST(ParticleEnsemble, ParticlesOfTheHostAreInvisible) {
    const ScatteringProperties p = scatter(1.5, 1.5, 550, {LogNormal{0.2, 1.3}});
    EXPECT_LT(p.extinction_um2, 1e-25);
    EXPECT_EQ(p.expansion.alpha1[0], 1.0);
}

TEST(ParticleEnsemble, RefusesWhatIsNotPhysical) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const SizeDistribution d{Monodisperse{0.1}};
    EXPECT_THROW(scatter({1.5, -0.1}, 1.5, 550, d), Error);
    EXPECT_THROW(scatter({nan, 0}, 1.5, 550, d), Error);
    EXPECT_THROW(scatter(0.0, 1.5, 550, d), Error);
    EXPECT_THROW(scatter(1.5, 0.0, 550, d), Error);
    EXPECT_THROW(scatter(1.5, 1.5, -550, d), Error);
    EXPECT_THROW(scatter(1.5, 1.5, nan, d), Error);
    EXPECT_THROW(scatter(1.6, 1.5, 550, d, {.tolerance = 0.0}), Error);
    EXPECT_THROW(scatter(1.6, 1.5, 550, d, {.packing_fraction = 0.8}), Error);
    EXPECT_THROW(scatter(1.6, 1.5, 550, {Monodisperse{1e4}}), Error);
    EXPECT_THROW(scatter(1.6, 1.5, 550, {Monodisperse{-1}}), Error);
    try {
        scatter({1.5, -0.1}, 1.5, 550, d, {}, {"paint.toml", 4, 2});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_THAT(error.what(), testing::StartsWith("paint.toml:4:2"));
    }
}

// Anywhere in the legal space the result is finite, conserves energy and is normalised, or the input is refused in
// words.
TEST(ParticleEnsemble, IsSoundForAnyLegalInput) {
    std::uint64_t state = 42;
    const auto uniform = [&](double low, double high) {
        state = state * 6364136223846793005ull + 1442695040888963407ull;
        return low + (high - low) * static_cast<double>(state >> 11) * 0x1p-53;
    };
    const auto log_uniform = [&](double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); };
    int accepted = 0;
    for (int i = 0; i < 300; ++i) {
        const double r = log_uniform(1e-4, 2.0);
        const SizeShape shapes[] = {Monodisperse{r},
                                    LogNormal{r, log_uniform(1.0001, 2.5)},
                                    Gamma{r, log_uniform(1e-4, 0.49)},
                                    ModifiedGamma{log_uniform(0.01, 1000), log_uniform(0.2, 100), r},
                                    PowerLaw{uniform(-20, 20), r, r * log_uniform(1.01, 100)},
                                    RosinRammler{r, log_uniform(0.5, 100)},
                                    Histogram{{r, r * 1.1, r * 3}, {uniform(0, 1), uniform(0, 1)}}};
        const SizeDistribution d{shapes[i % 7], static_cast<SizeWeighting>(i / 7 % 3)};
        const Complex m(uniform(0.1, 4.0), i % 2 ? log_uniform(1e-8, 8.0) : 0.0);
        const double f = i % 5 == 0 ? uniform(0.0, 0.64) : 0.0;
        try {
            const ScatteringProperties p = scatter(m, uniform(1.0, 1.7), uniform(300, 1000), d,
                                                   {.tolerance = 0.02, .packing_fraction = f, .max_radii = 129});
            ++accepted;
            EXPECT_TRUE(std::isfinite(p.extinction_um2) && std::isfinite(p.quadrature_error)) << i;
            EXPECT_GT(p.scattering_um2, 0.0) << i;
            EXPECT_GE(p.absorption_um2, 0.0) << i;
            EXPECT_EQ(p.absorption_um2 == 0.0, m.imag() == 0.0) << i;
            EXPECT_NEAR(p.extinction_um2, p.scattering_um2 + p.absorption_um2, 1e-14 * p.extinction_um2) << i;
            EXPECT_GT(p.mean_volume_um3, 0.0) << i;
            EXPECT_NEAR(p.expansion.alpha1[0], 1.0, 1e-12) << i;
            EXPECT_LT(std::abs(p.asymmetry()), 1.0) << i;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << i;
        }
    }
    EXPECT_GT(accepted, 250);
}

TEST(Mixture, AddsCrossSectionsAndWeighsExpansions) {
    const ScatteringProperties white = scatter(2.75, 1.495, 550, {LogNormal{0.125, 1.3}}, {.tolerance = 1e-4});
    const ScatteringProperties red = scatter({3.19, 0.48}, 1.495, 550, {LogNormal{0.05, 1.3}}, {.tolerance = 1e-4});
    const MixtureComponent components[] = {{white, 0.5}, {red, 2.0}};
    const ScatteringMedium medium = mix(components);
    EXPECT_DOUBLE_EQ(medium.extinction_per_um, 0.5 * white.extinction_um2 + 2.0 * red.extinction_um2);
    EXPECT_DOUBLE_EQ(medium.albedo(), medium.scattering_per_um / medium.extinction_per_um);
    EXPECT_NEAR(medium.expansion.alpha1[0], 1.0, 1e-13);
    const double g = (0.5 * white.scattering_um2 * white.asymmetry() + 2.0 * red.scattering_um2 * red.asymmetry());
    EXPECT_NEAR(medium.asymmetry(), g / medium.scattering_per_um, 1e-14);
    EXPECT_EQ(medium.expansion.order(), std::max(white.expansion.order(), red.expansion.order()));

    // A kind mixed with itself stays what it is.
    const MixtureComponent halves[] = {{red, 1.0}, {red, 3.0}};
    EXPECT_NEAR(mix(halves).expansion.beta1[2], red.expansion.beta1[2], 1e-15);
    EXPECT_EQ(mix({}).albedo(), 0.0);
    EXPECT_EQ(mix({}).expansion.alpha1[0], 1.0);
}

// Small spheres: the average of polarizabilities squared, C_sca ~ (2 |K_o|^2 + |K_e|^2)/3.
TEST(Mixture, BirefringentParticles) {
    const auto sphere = [](double n) { return scatter(n, 1.495, 550, {Monodisperse{1e-3}}); };
    const ScatteringProperties p = average_birefringent(sphere(2.6), sphere(2.9));
    const auto k2 = [](double n) { return std::pow((n * n / 1.495 / 1.495 - 1) / (n * n / 1.495 / 1.495 + 2), 2); };
    EXPECT_NEAR(p.scattering_um2 / sphere(2.6).scattering_um2, (2 * k2(2.6) + k2(2.9)) / (3 * k2(2.6)), 1e-3);
    EXPECT_NEAR(p.expansion.alpha1[0], 1.0, 1e-14);
    EXPECT_NEAR(p.effective_radius_um, 1e-3, 1e-15);
}

// Counted by volume, a spread a little above 3 has a number of particles that hardly falls towards small ones; 3.2 lies
// between 3.0, where it rises, and 3.6.
TEST(ParticleEnsemble, GroundPowdersOfEverySpreadScatter) {
    const auto scattering_per_volume = [](double spread) {
        const ScatteringProperties p =
            scatter(2.7, 1.5, 550.0, {RosinRammler{0.1, spread}, SizeWeighting::volume}, {.tolerance = 1e-4});
        return p.scattering_um2 / p.mean_volume_um3;
    };
    const double between = scattering_per_volume(3.2);
    EXPECT_GT(between, std::min(scattering_per_volume(3.0), scattering_per_volume(3.6)));
    EXPECT_LT(between, std::max(scattering_per_volume(3.0), scattering_per_volume(3.6)));
}

}  // namespace
}  // namespace patina::optics
