#pragma once
// Delta-M truncation of forward peaks that the quadrature cannot carry (Wiscombe 1977, J. Atmos. Sci. 34, 1408).

#include <vector>

#include "patina/rt/solver.h"

namespace patina::rt {

// The scattering matrix of a layer whose expansion is longer than 2N terms is split into f 2 delta(1 - cos) times the
// identity and a matrix of 2N terms, f = alpha1[2N]/(4N+1); light in the delta counts as unscattered, which scales
// optical thickness by 1 - omega f and the albedo to omega (1-f)/(1 - omega f). In Stokes form the identity puts
// f (2l+1) into each of alpha1 .. alpha4 and nothing into beta1, beta2.
struct Truncation {
    Problem scaled;               // what remains
    std::vector<double> forward;  // f of each layer, 0 where nothing is truncated
    // Of each truncated layer omega/(1 - omega f) S_l less the scaled omega S_l: what single scattering lacks per
    // scaled optical depth (TMS; Nakajima & Tanaka 1988, J. Quant. Spectrosc. Radiat. Transf. 40, 51, eq. 14). Else
    // empty.
    std::vector<optics::ExpansionCoefficients> lacking;
    int order = 0;  // of the longest of `lacking`; 0 when nothing is truncated

    // Optical depth in the scaled stack of a depth in the whole one.
    double scaled_depth(const Problem& whole, double depth) const;
};

Truncation truncate(const Problem& problem, int streams);

// Says what was truncated.
void report_truncation(const Truncation& truncation, Diagnostics& diagnostics);

}  // namespace patina::rt
