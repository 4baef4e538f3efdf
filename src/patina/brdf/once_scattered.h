#pragma once
// Light scattered once in a layer, in closed form: what no table on nodes follows when the particles are large.

#include <span>
#include <vector>

#include "patina/optics/scattering/expansion_coefficients.h"
#include "patina/optics/stokes.h"

namespace patina::brdf {

// A layer of a stack at one wavelength. Light coming down on the stack as a unit Stokes vector (flux through horizontal
// planes) goes down under the layer's top as `down`, and up above its bottom as Delta `up`, Delta = diag(1,1,-1,-1),
// before it is scattered.
struct OnceScattered {
    double index_ratio = 1.0;        // refractive index over that above the stack
    double optical_thickness = 0.0;  // may be infinite
    // Scattering coefficient over extinction times the coefficients of the scattering matrix, l = 0 .. L.
    optics::ExpansionCoefficients scattering;
    std::vector<optics::Mueller> down, up;  // at the angles of incidence of the table's specular part
};

// The BRDF of once scattered light, 1/sr, in the solver's convention: with B and S the integrals over depth of light
// leaving through the face it came in by and through the other one, and Z the phase matrix from direction to direction,
//   f = [E_o (B Z(up,down) D_i + S Z(up,up) U_i) + X_o (S Z(down,down) D_i + B Z(down,up) U_i)] / (4 pi n^2 mu_o'
//   mu_i'),
// E_o and X_o being D_o and U_o the other way round by reciprocity, mu' cosines in the layer.
class OnceScatteredLight {
  public:
    // `evaluations`: how many are about to follow; many are worth a table of the scattering matrix. Both must outlive
    // this.
    OnceScatteredLight(const OnceScattered& layer, std::span<const double> theta_deg, std::size_t evaluations);

    optics::Mueller operator()(double mu_o, double mu_i, double phi) const;

  private:
    struct Ray {
        double mu;  // in the layer, 0 where light does not get there
        optics::Mueller down, up;
    };
    Ray ray(double mu) const;
    optics::Mueller phase_matrix(double to, double from, double phi) const;
    // a1, a2, a3, a4, b1, b2.
    Eigen::Array<double, 6, 1> elements(double cosine) const;

    const OnceScattered& layer_;
    std::span<const double> theta_deg_;
    Eigen::Array<double, 6, Eigen::Dynamic> tabulated_;  // at even angles from 0 to 180 deg
};

}  // namespace patina::brdf
