// The renderer's frames against what the solvers of the radiative transfer equation mean by U: light scattered once in
// a thin layer of Rayleigh scatterers, from the solver through a table's conventions to the renderer, and from fields
// in space.

#include <gtest/gtest.h>

#include "patina/core/constants.h"
#include "patina/render/stokes_frames.h"
#include "patina/rt/solver.h"

namespace patina::render {
namespace {

using Eigen::Vector3d;

TEST(SolverBridge, ThinRayleighLayerScattersTheFieldOfADipole) {
    rt::Problem problem;
    rt::Layer layer;
    const double tau = 1e-5;
    layer.optical_thickness = tau;
    layer.single_scattering_albedo = 1;
    // Rayleigh scattering: Hansen & Travis (1974), in the expansion of de Haan et al. (1987).
    layer.expansion = {{1, 0, 0.5}, {0, 0, 3}, {0, 0, 0}, {0, 1.5, 0}, {0, 0, std::sqrt(6.0) / 2}, {0, 0, 0}};
    problem.layers = {layer};

    rt::FieldRequest request;
    request.mu_i = 0.8;
    request.optical_depths = {0};
    request.mu_o = {0.35, 0.9};
    request.phi = {0.4, 2.0, -1.1};
    // Light linearly polarized at some angle, in the solver's parameters; the beam's flux is pi.
    request.incident = {1, 0.3, -0.5, 0.2};
    const rt::Field field = rt::solvers().front()->field(problem, request, {});
    for (std::size_t o = 0; o < request.mu_o.size(); ++o)
        for (std::size_t p = 0; p < request.phi.size(); ++p) {
            // Both rays in space, the incident one at azimuth 0.
            const double mu_o = request.mu_o[o], phi = request.phi[p], s_i = std::sqrt(1 - 0.64),
                         s_o = std::sqrt(1 - mu_o * mu_o);
            const Vector3d k_in(s_i, 0, -0.8), k_out(s_o * std::cos(phi), s_o * std::sin(phi), mu_o);
            const Vector3d x_in = meridian_axis(k_in.cast<float>()).cast<double>(), y_in = k_in.cross(x_in);
            const Vector3d x_out = meridian_axis(k_out.cast<float>()).cast<double>(), y_out = k_out.cross(x_out);
            Eigen::Matrix2d jones;  // a dipole keeps the part of the field across the new ray
            jones << x_out.dot(x_in), x_out.dot(y_in), y_out.dot(x_in), y_out.dot(y_in);

            // Coherence matrix of the incident light in the renderer's parameters (U turned by the bridge), and back.
            const std::complex<double> i(0, 1);
            const Eigen::Vector4d in = from_solver(request.incident);
            Eigen::Matrix2cd c;
            c << in[0] + in[1], in[2] + i * in[3], in[2] - i * in[3], in[0] - in[1];
            c = 0.5 * (jones * c * jones.transpose()).eval();
            const Eigen::Vector4d expected =
                1.5 * Eigen::Vector4d((c(0, 0) + c(1, 1)).real(), (c(0, 0) - c(1, 1)).real(), 2 * c(0, 1).real(),
                                      2 * c(0, 1).imag());
            // Radiance of a thin layer: flux pi times P / (4 pi) times tau / mu_o.
            const Eigen::Vector4d found = from_solver(field.upward[0][o][p]) * 4 * mu_o / tau;
            // Second scattering adds a share of tau / mu; single-precision axes 1e-7.
            EXPECT_LT((found - expected).norm(), 1e-4) << found.transpose() << "\n" << expected.transpose();
        }
}

}  // namespace
}  // namespace patina::render
