// Light forwards and backwards through the same event: the matrix drawn for a path that runs against the light, turned
// around, is the matrix of the light.

#include "patina/render/light_beam.h"

#include <gtest/gtest.h>

#include "patina/render/bsdf_set.h"

namespace patina::render {
namespace {

// The Stokes vector of a beam in the frame with this x axis.
Eigen::Vector4f stokes_in(const LightBeam& beam, const Vec3& x_axis) {
    LightBeam turned = beam;
    const DoubleAngle r = rotation_between(beam.direction, beam.x_axis, x_axis);
    const float q = beam.stokes[4], u = beam.stokes[8];
    return {turned.stokes[0], q * r.cos + u * r.sin, u * r.cos - q * r.sin, turned.stokes[12]};
}

void expect_reciprocal(const Bsdf& bsdf, const Vec3& outgoing, float u, const char* what) {
    const Wavelengths w = Wavelengths::all_at(550);
    const ShadingPoint point{&w, Vec2::Zero(), &bsdf};
    BsdfSample against, along;
    ASSERT_TRUE(bsdf_sample(bsdf, point, outgoing, u, Vec2(0.3f, 0.6f), against)) << what;
    ASSERT_TRUE(bsdf_sample(bsdf, point, against.incident, u, Vec2(0.3f, 0.6f), along)) << what;
    EXPECT_NEAR((along.incident - outgoing).norm(), 0, 1e-5f) << what;

    // A beam of every polarization at once; radiance gains the index squared, flux does not.
    LightBeam radiance = LightBeam::unpolarized(splat(1), -against.incident);
    radiance.stokes = make_stokes(splat(1), splat(0.5f), splat(-0.4f), splat(0.6f));
    LightBeam flux = radiance;
    radiance.scatter(against.weight, outgoing);
    flux.scatter(reversed(along.weight), outgoing);
    Vec3 x, y;
    orthonormal_basis(outgoing, x, y);
    const Eigen::Vector4f a = stokes_in(radiance, x) * against.pdf * sqr(against.eta),
                          b = stokes_in(flux, x) * along.pdf * sqr(along.eta);
    // Single precision, through a handful of rotations.
    EXPECT_NEAR((a - b).norm(), 0, 1e-5f) << what << ": " << a.transpose() << " | " << b.transpose();
    EXPECT_GT(a[0], 0.01f) << what;
}

TEST(LightBeam, ReversedMatricesAreTheMatricesOfTheReversedRay) {
    const Texture one(Spectrum(1.0f));
    const Vec3 oblique = Vec3(0.5f, -0.3f, 0.7f).normalized();
    using Kind = PolarizationElement::Kind;
    const ScalarTexture theta_deg(23), delta_deg(63), none;
    expect_reciprocal({LinearPolarizer{{Kind::linear_polarizer, theta_deg, none, one}}}, oblique, 0.5f, "polarizer");
    expect_reciprocal({Retarder{{Kind::retarder, theta_deg, delta_deg, one}}}, oblique, 0.5f, "retarder");
    expect_reciprocal({CircularPolarizer{{Kind::right_circular, theta_deg, none, one}}}, oblique, 0.5f, "circular");
    expect_reciprocal({Conductor{Spectrum(0.4f), Spectrum(2.5f), one}}, oblique, 0.5f, "conductor");
    const Bsdf glass{Dielectric{Spectrum(1.5f), Spectrum(1.0f), one, one, false}};
    expect_reciprocal(glass, oblique, 0.0f, "reflection");
    expect_reciprocal(glass, oblique, 0.99f, "refraction out of glass");
    // From inside at 30 degrees, below the critical angle of 42.
    expect_reciprocal(glass, Vec3(0.5f, 0, -0.8660254f), 0.99f, "refraction into glass");
}

}  // namespace
}  // namespace patina::render
