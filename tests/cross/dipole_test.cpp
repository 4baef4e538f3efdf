// How far diffusion is from the transport equation: the dipole's albedo against the solver's half space.

#include "patina/render/bsdfs/dipole.h"

#include <gtest/gtest.h>

#include "patina/core/constants.h"
#include "patina/rt/solver.h"

namespace patina::render {
namespace {

// Directional-hemispherical reflectance without the mirror part, incident at 45 degrees (the nearest node), of
// isotropic scatterers under a surface of index 1.5; and the dipole's for the same, (1 - F) total.
struct Albedos {
    double transport, dipole;
};
Albedos albedos(double single_scattering_albedo) {
    rt::Problem problem;
    problem.layers = {
        {INFINITY, single_scattering_albedo, {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 1.5}};
    rt::SolveOptions options;
    options.most_fourier_orders = 1;
    const rt::Reflection r = rt::solvers().front()->reflection(problem, options);
    const auto nodes = static_cast<Eigen::Index>(r.mu.size());
    Eigen::Index i = 0;
    while (i + 1 < nodes && r.mu[static_cast<std::size_t>(i)] < std::sqrt(0.5)) ++i;
    double transport = 0;
    for (Eigen::Index o = 0; o < nodes; ++o)
        transport += 2 * pi * r.modes[0](4 * o, 4 * i) * r.mu[static_cast<std::size_t>(o)] *
                     r.weights[static_cast<std::size_t>(o)];

    const Spectrum inside(1.5f), outside(1.0f);
    const DipoleProfile profile(splat(static_cast<float>(1 - single_scattering_albedo)),
                                splat(static_cast<float>(single_scattering_albedo)),
                                diffuse_internal_reflectance(inside, outside).at(Wavelengths::all_at(550)));
    const optics::Mueller mirror = rt::specular_surface(problem, r.mu[static_cast<std::size_t>(i)]);
    return {transport, (1 - mirror(0, 0)) * profile.total[0]};
}

// The documentation's figures (docs/models.md): half a percent near conservative scattering; the light that is
// scattered but once, which is not diffuse, counts ever more where much is absorbed.
TEST(DipoleAgainstTransport, AlbedoIsRightWhereLittleIsAbsorbed) {
    struct Case {
        double albedo, ratio;
    };
    for (const Case& c : {Case{0.9999, 0.995}, Case{0.99, 0.98}, Case{0.9, 1.16}, Case{0.5, 1.51}}) {
        const Albedos a = albedos(c.albedo);
        // A unit of the last digit that is documented.
        EXPECT_NEAR(a.dipole / a.transport, c.ratio, 0.01) << c.albedo;
    }
}

}  // namespace
}  // namespace patina::render
