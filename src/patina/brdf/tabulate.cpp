#include "patina/brdf/tabulate.h"

#include <cmath>

#include "patina/brdf/meridian_frame.h"
#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/core/parallel.h"
#include "patina/math/quadrature.h"

namespace patina::brdf {

using optics::Mueller;

namespace {

BodyModes project(const BodyFunction& function, double wavelength_nm, const std::vector<double>& mu, int orders) {
    const int azimuths = 2 * orders + 1;
    const auto n = static_cast<Eigen::Index>(mu.size());
    BodyModes body{std::vector<Eigen::MatrixXd>(orders, Eigen::MatrixXd::Zero(4 * n, 4 * n))};
    parallel_for(0, n, [&](std::ptrdiff_t o) {
        for (Eigen::Index i = 0; i < n; ++i)
            for (int p = 0; p < azimuths; ++p) {
                const double phi = 2 * pi * p / azimuths;
                const Mueller value = function(wavelength_nm, mu[o], mu[i], phi) / azimuths;
                for (int m = 0; m < orders; ++m) {
                    auto block = body.modes[m].block<4, 4>(4 * o, 4 * i);
                    block.topLeftCorner<2, 2>() += std::cos(m * phi) * value.topLeftCorner<2, 2>();
                    block.bottomRightCorner<2, 2>() += std::cos(m * phi) * value.bottomRightCorner<2, 2>();
                    block.topRightCorner<2, 2>() -= std::sin(m * phi) * value.topRightCorner<2, 2>();
                    block.bottomLeftCorner<2, 2>() += std::sin(m * phi) * value.bottomLeftCorner<2, 2>();
                }
            }
    });
    return body;
}

}  // namespace

MuellerTable tabulate(const BodyFunction& function, const TabulateOptions& options) {
    PATINA_EXPECT(options.nodes >= 2 && options.orders >= 1 && !options.wavelengths_nm.empty());
    MuellerTable table;
    table.wavelengths_nm = options.wavelengths_nm;
    const math::Quadrature quadrature = math::gauss_legendre(options.nodes, 0.0, 1.0);
    table.mu = quadrature.nodes;
    table.mu_weights = quadrature.weights;
    for (double wavelength_nm : options.wavelengths_nm)
        table.body.push_back(project(function, wavelength_nm, table.mu, options.orders));

    for (int angle = 0; angle <= 90; ++angle) table.specular_theta_deg.push_back(angle);
    const std::vector<Mueller> dark(table.specular_theta_deg.size(), Mueller::Zero());
    table.specular_surface.assign(table.wavelengths_nm.size(), dark);
    table.specular_coherent.assign(table.wavelengths_nm.size(), dark);
    return table;
}

BodyFunction lambertian_body(double reflectance) {
    return [reflectance](double, double, double, double) {
        Mueller result = Mueller::Zero();
        result(0, 0) = reflectance / pi;
        return result;
    };
}

BodyFunction single_rayleigh_body(double optical_thickness) {
    PATINA_EXPECT(optical_thickness >= 0);
    return [optical_thickness](double, double mu_o, double mu_i, double phi) -> Mueller {
        const double escaping = -std::expm1(-optical_thickness * (1 / mu_o + 1 / mu_i));
        return rayleigh_phase_matrix(mu_o, mu_i, phi) * (escaping / (4 * pi * (mu_o + mu_i)));
    };
}

Mueller rayleigh_phase_matrix(double mu_o, double mu_i, double phi) {
    const MeridianFrame in = meridian_frame(-mu_i, 0.0), out = meridian_frame(mu_o, phi);

    // The scattered field is the incident one projected on the plane across the new direction.
    const double pp = out.p.dot(in.p), ps = out.p.dot(in.s), sp = out.s.dot(in.p), ss = out.s.dot(in.s);

    // The Mueller matrix of this real Jones matrix in I = |p|^2 + |s|^2, Q = |p|^2 - |s|^2, U = 2 Re p s*, V = -2 Im p
    // s*.
    Mueller result;
    const double from_p_to_i = pp * pp + sp * sp, from_s_to_i = ps * ps + ss * ss;
    const double from_p_to_q = pp * pp - sp * sp, from_s_to_q = ps * ps - ss * ss;
    result << (from_p_to_i + from_s_to_i) / 2, (from_p_to_i - from_s_to_i) / 2, pp * ps + sp * ss, 0,  //
        (from_p_to_q + from_s_to_q) / 2, (from_p_to_q - from_s_to_q) / 2, pp * ps - sp * ss, 0,        //
        pp * sp + ps * ss, pp * sp - ps * ss, pp * ss + ps * sp, 0,                                    //
        0, 0, 0, pp * ss - ps * sp;
    return 1.5 * result;
}

}  // namespace patina::brdf
