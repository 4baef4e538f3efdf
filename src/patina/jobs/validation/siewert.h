#pragma once
// Siewert's problem IIA and what ignoring polarization costs in it.

#include <vector>

#include "patina/rt/solver.h"

namespace patina::jobs::validation {

rt::Problem siewert_problem();

// The intensity leaving the top, as published, with all four Stokes components solved for, and with one only; by
// the default solver, for a random walk sees nothing along the horizon.
struct PolarizationRow {
    double zenith_deg, phi_deg;
    double published, vector, scalar;
};
std::vector<PolarizationRow> cost_of_ignoring_polarization();

}  // namespace patina::jobs::validation
