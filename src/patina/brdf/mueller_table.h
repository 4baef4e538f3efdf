#pragma once
// The 4x4 Mueller BRDF of a coating per wavelength: the contract between the solver and everything that uses its
// result.
//
// A table holds the body (subsurface) part as Fourier modes on cosine nodes, and the specular (delta) part as Mueller
// matrices against the angle of incidence. Conventions: docs/conventions.md. It knows neither solver nor renderer.

#include <map>
#include <span>
#include <string>
#include <vector>

#include "patina/brdf/once_scattered.h"
#include "patina/core/error.h"
#include "patina/optics/stokes.h"

namespace patina::brdf {

// The body BRDF of one wavelength, 1/sr. See rt/solver.h (Reflection) for the meaning of modes and their phi
// dependence: elements {I,Q}<-{I,Q} and {U,V}<-{U,V} take cos(m phi), {I,Q}<-{U,V} take -sin(m phi), {U,V}<-{I,Q} take
// +sin(m phi), factor (2 - delta_m0).
struct BodyModes {
    std::vector<Eigen::MatrixXd> modes;  // [m] (4N x 4N), block (o, i)
};

// Provenance: how to make the table again.
struct Provenance {
    std::string command;  // "patina solve tio2.toml -o a.h5"
    std::string recipe;   // the recipe's text
    std::string recipe_path;
    std::string software;  // "patina 0.1.0"
    std::string solver;
    std::map<std::string, std::string> notes;  // materials' citations, extrapolation flags, ...
};

// Body BRDF values on a product grid of directions, all three axes as asked for.
struct MuellerGrid {
    int outgoing = 0, incident = 0, azimuths = 0;
    std::vector<optics::Mueller> values;  // [outgoing][incident][azimuths]

    const optics::Mueller& at(int o, int i, int p) const {
        return values[(static_cast<std::size_t>(o) * incident + i) * azimuths + p];
    }
};

class MuellerTable {
  public:
    std::vector<double> wavelengths_nm;      // ascending, W >= 1
    std::vector<double> mu;                  // ascending cosines in air (Gauss nodes on (0,1)), N >= 2
    std::vector<double> mu_weights;          // N
    std::vector<BodyModes> body;             // W
    std::vector<double> specular_theta_deg;  // ascending 0 .. 90, A
    std::vector<std::vector<optics::Mueller>> specular_surface;   // [W][A] Fresnel reflection at the top
    std::vector<std::vector<optics::Mueller>> specular_coherent;  // [W][A] unscattered beam returned by a metal base
    // [W][layers] What the modes leave out and evaluation adds: light scattered once in layers of sharp forward peaks,
    // in closed form. Empty when the modes hold all; a wavelength's list may be empty.
    std::vector<std::vector<OnceScattered>> once_scattered;
    std::vector<double> error_estimate;  // [W] of the body BRDF, absolute, 1/sr; empty when not estimated
    Provenance provenance;

    // Throws Error(input) at `where` unless the shapes fit together, axes ascend and every value is finite.
    void validate(const SourceLocation& where = {}) const;

    // The body BRDF in the solver's convention: mu_o, mu_i in [0, 1], phi in radians = azimuth of the outgoing minus
    // the incident propagation direction. Linear in wavelength, clamped at the ends; polynomial in mu, mode by mode,
    // exact at the nodes. Modes of odd m carry a factor sqrt(1 - mu^2) for each direction (d^l_m0 and d^l_m,+-2 do),
    // which no polynomial follows near the normal: it is divided out before interpolating and multiplied back after.
    //
    // Not promised: positivity. Where the BRDF is steep in mu on the scale of the nodes' spacing (a thin index-matched
    // layer at grazing angles), the polynomial can undershoot below zero by a small fraction of its neighbours' values.
    optics::Mueller evaluate(double wavelength_nm, double mu_o, double mu_i, double phi) const;

    // The same on a product grid by matrix products: each mode is interpolated once for all azimuths. For tabulating.
    MuellerGrid evaluate_grid(double wavelength_nm, std::span<const double> mu_o, std::span<const double> mu_i,
                              std::span<const double> phi) const;

    // Order m of the body BRDF between the given cosines, (4 x mu_o.size()) x (4 x mu_i.size()); zero beyond the last.
    // Once scattered light that is kept in closed form is no part of it.
    Eigen::MatrixXd mode(double wavelength_nm, int m, std::span<const double> mu_o, std::span<const double> mu_i) const;
    // How many orders the body BRDF has at a wavelength.
    int orders(double wavelength_nm) const;

    // The delta part (surface + coherent) along the mirror direction; cubic in the angle of incidence, whose steep end
    // at grazing a straight line between whole degrees would miss by 1e-3.
    optics::Mueller specular(double wavelength_nm, double mu_i) const;

    // The once scattered part alone, element by element of once_scattered, at a tabulated wavelength (a position).
    optics::Mueller evaluate_once_scattered(int w, double mu_o, double mu_i, double phi) const;

    // Directional-hemispherical reflectance of the body for a Stokes vector incident at mu_i.
    double body_albedo(double wavelength_nm, double mu_i, const optics::Stokes& incident = {1, 0, 0, 0}) const;
};

}  // namespace patina::brdf
