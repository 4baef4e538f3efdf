#pragma once
// Building a table from a body BRDF known as a function: closed forms, and measured BRDFs brought into the table's
// form.

#include <functional>
#include <vector>

#include "patina/brdf/mueller_table.h"

namespace patina::brdf {

// A body BRDF in the solver's convention, 1/sr.
using BodyFunction = std::function<optics::Mueller(double wavelength_nm, double mu_o, double mu_i, double phi)>;

struct TabulateOptions {
    std::vector<double> wavelengths_nm = {550.0};
    int nodes = 16;   // Gauss-Legendre nodes of mu on (0, 1)
    int orders = 16;  // Fourier modes m = 0 .. orders - 1
};

// The table of `function`, which must be isotropic and mirror symmetric in azimuth. Modes are projected with 2 orders +
// 1 azimuths, exact for a BRDF band limited to orders - 1. The specular part is zero at 0, 1, .. 90 deg.
MuellerTable tabulate(const BodyFunction& function, const TabulateOptions& options = {});

// A depolarizing Lambertian surface: reflectance / pi in the element I <- I.
BodyFunction lambertian_body(double reflectance);

// Light scattered once in a non-absorbing layer of Rayleigh scatterers without an interface (Chandrasekhar 1960,
// section 17): P(Theta) (1 - exp(-tau (1/mu_o + 1/mu_i))) / (4 pi (mu_o + mu_i)). tau may be infinite.
BodyFunction single_rayleigh_body(double optical_thickness);

// The Rayleigh phase matrix, mean over the sphere 1, between meridian frames, from electric fields in explicit frames:
// light arriving at the cosine -mu_i from the outward normal, leaving at mu_o.
optics::Mueller rayleigh_phase_matrix(double mu_o, double mu_i, double phi);

}  // namespace patina::brdf
