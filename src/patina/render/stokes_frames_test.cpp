#include "patina/render/stokes_frames.h"

#include <complex>

#include <gtest/gtest.h>

#include "patina/brdf/half_angle_table.h"
#include "patina/brdf/tabulate.h"
#include "patina/core/constants.h"
#include "patina/optics/fresnel.h"
#include "patina/render/fresnel_packet.h"
#include "patina/render/mueller_packet.h"
#include "patina/render/paint_table.h"

namespace patina::render {
namespace {

using Complex = std::complex<double>;
using optics::Mueller;
using optics::Stokes;

Vec3 direction(double theta_deg, double phi_deg) {
    const double s = std::sin(radians(theta_deg));
    return Eigen::Vector3d(s * std::cos(radians(phi_deg)), s * std::sin(radians(phi_deg)), std::cos(radians(theta_deg)))
        .cast<float>();
}

// The Mueller matrix of fields (E_x, E_y) -> J (E_x, E_y) in right-handed frames, by the definition of the renderer's
// Stokes parameters: column s is what comes out for coherence matrices that carry the s-th parameter alone.
Mueller mueller_of_jones(const Eigen::Matrix2cd& jones) {
    const Complex i(0, 1);
    Eigen::Matrix2cd basis[4];
    basis[0] << 0.5, 0, 0, 0.5;
    basis[1] << 0.5, 0, 0, -0.5;
    basis[2] << 0, 0.5, 0.5, 0;
    basis[3] << 0, 0.5 * i, -0.5 * i, 0;  // V = 2 Im(E_x E_y*)
    Mueller m;
    for (int s = 0; s < 4; ++s) {
        const Eigen::Matrix2cd c = jones * basis[s] * jones.adjoint();
        m.col(s) =
            Stokes((c(0, 0) + c(1, 1)).real(), (c(0, 0) - c(1, 1)).real(), 2 * c(0, 1).real(), 2 * c(0, 1).imag());
    }
    return m;
}

Eigen::Matrix2cd dipole(const Vec3& k_in, const Vec3& x_in, const Vec3& k_out, const Vec3& x_out) {
    const Vec3 y_in = k_in.cross(x_in), y_out = k_out.cross(x_out);
    Eigen::Matrix2cd jones;
    jones << x_out.dot(x_in), x_out.dot(y_in), y_out.dot(x_in), y_out.dot(y_in);
    return jones;
}

TEST(StokesFrames, LightAlongXLooksDiagonalInATurnedFrame) {
    // Seen in a frame turned by +45 degrees, light along x vibrates along -45 degrees (Mitsuba 3, polarization
    // chapter).
    const Vec3 k = Vec3::UnitZ(), x = Vec3::UnitX(), turned = Vec3(1, 1, 0).normalized();
    const Stokes seen = rotator(rotation_between(k, x, turned)) * Stokes(1, 1, 0, 0);
    EXPECT_LT((seen - Stokes(1, 0, -1, 0)).norm(), 1e-6);  // float frames
}

// A small sphere scatters the field E into E - k (k.E). The solver's Rayleigh matrix after the bridge must be that of
// the fields in the renderer's frames: this fixes the sign of U, for every pair of directions.
TEST(StokesFrames, BridgeGivesDipoleScatteringOfFields) {
    for (auto [i, o] : {std::pair{direction(45, 180), direction(20, 90)},
                        {direction(70, 30), direction(60, -100)},
                        {direction(10, 200), direction(85, 210)}}) {
        const Vec3 k_in = -i;
        const double phi = std::atan2(o.y(), o.x()) - std::atan2(k_in.y(), k_in.x());
        const Mueller bridged = from_solver(brdf::rayleigh_phase_matrix(o.z(), i.z(), phi));
        const Mueller fields = 1.5 * mueller_of_jones(dipole(k_in, meridian_axis(k_in), o, meridian_axis(o)));
        EXPECT_LT((bridged - fields).norm(), 2e-6) << bridged << "\n\n" << fields;  // float frames
    }
}

// V needs phases: reflection by a metal and total reflection, from complex amplitudes of fields along s and p, p = s x
// k.
TEST(StokesFrames, FresnelPacketsAreThoseOfFields) {
    for (double theta_deg : {10.0, 45.0, 75.0}) {
        const double cos_i = std::cos(radians(theta_deg));
        for (const Complex index : {Complex(0.8, 5.3), Complex(1.5, 0.0), Complex(1 / 1.5, 0.0)}) {
            const optics::FresnelAmplitudes amplitude = optics::fresnel_amplitudes(cos_i, 1.0, index);
            // x = s and y = k x s = -p, before and after.
            Eigen::Matrix2cd jones;
            jones << amplitude.r_s, 0, 0, amplitude.r_p;
            const Mueller fields = mueller_of_jones(jones);
            const FresnelPacket f = index.imag() > 0
                                        ? fresnel_conductor(cos_i, splat(index.real()), splat(index.imag()))
                                        : fresnel_dielectric(cos_i, splat(index.real())).reflection;
            ScatteringMatrix packet;
            packet.set_fresnel(f.a, f.b, f.c, f.d, Vec3::UnitX(), Vec3::UnitX());
            // Single precision, and differences of nearly equal amplitudes.
            EXPECT_LT((packet.matrix(2) - fields).norm(), 3e-6) << theta_deg << " degrees, " << index;
            // The same through the bridge: x from e_theta (in the plane) to s (across it).
            const Vec3 s = Vec3::UnitY(), in = -direction(theta_deg, 180), out = direction(theta_deg, 0);
            const Mueller bridged = rotate_frames(from_solver(optics::fresnel_reflection(cos_i, 1.0, index)), in,
                                                  meridian_axis(in), s, out, meridian_axis(out), s);
            EXPECT_LT((bridged - fields).norm(), 3e-6) << theta_deg << " degrees, " << index;
        }
    }
}

TEST(StokesFrames, RefractionConservesFluxAndBrewstersAnglePassesP) {
    for (float eta : {1.5f, 1 / 1.5f})
        for (float cos_i : {0.99f, 0.6f, 0.2f}) {
            const FresnelInterface f = fresnel_dielectric(cos_i, splat(eta));
            EXPECT_NEAR(f.reflection.a[0] + f.transmission.a[0], 1, 1e-6);
            EXPECT_NEAR(f.reflection.b[0] + f.transmission.b[0], 0, 1e-6);
            const Mueller expected = optics::fresnel_transmission(cos_i, 1.0, eta);
            EXPECT_NEAR(f.transmission.a[0], expected(0, 0), 2e-6);
            EXPECT_NEAR(f.transmission.b[0], -expected(0, 1), 2e-6);
            EXPECT_NEAR(f.transmission.c[0], expected(2, 2), 2e-6);
        }
    const FresnelInterface brewster = fresnel_dielectric(std::cos(std::atan(1.5f)), splat(1.5f));
    EXPECT_NEAR(brewster.reflection.a[0], brewster.reflection.b[0], 1e-6);  // R_p = 0
}

// The compact table gives back what it was made from, in frames that two modules define independently.
TEST(PaintTable, GivesBackItsTableInTheFramesOfTheScatteringPlane) {
    const brdf::MuellerTable table = brdf::tabulate(brdf::single_rayleigh_body(0.7), {.nodes = 24, .orders = 3});
    const PaintTable compact(table);
    const Wavelengths w = Wavelengths::all_at(550);
    double largest = 0;
    for (auto [i, o] : {std::pair{direction(45, 180), direction(20, 90)},
                        {direction(70, 30), direction(60, -100)},
                        {direction(10, 200), direction(70, 215)},
                        {direction(33, 20), direction(5, 100)},
                        {direction(50, 10), direction(50.5, 11)},
                        {direction(0, 0), direction(40, 77)}}) {
        const Eigen::Vector3d id = i.cast<double>(), od = o.cast<double>();
        const brdf::DirectionPair pair{id, od, id.cross(od).normalized()};
        const Mueller expected =
            brdf::to_half_angle_frames(table.evaluate(550, o.z(), i.z(), brdf::relative_azimuth(pair)), pair);
        ScatteringMatrix f;
        compact.evaluate(w, o, i, false, f);
        const Vec3 x = pair.stokes_x.cast<float>();
        const Mueller found = rotate_frames(f.matrix(1), -i, f.x_in, x, o, f.x_out, x);
        largest = std::max(largest, (found - expected).norm() / expected(0, 0));
    }
    // Linear interpolation errs by h^2/8 f'' for steps of 2.9 and 5.6 degrees: 1e-3 each for f'' of the order of f, and
    // half precision by 5e-4.
    EXPECT_LT(largest, 6e-3);
}

}  // namespace
}  // namespace patina::render
