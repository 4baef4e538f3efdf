#pragma once
// The body BRDF of one wavelength as a table holds it: modes on nodes, and sharp once scattered light in closed form.

#include <vector>

#include "patina/brdf/mueller_table.h"
#include "patina/rt/solver.h"

namespace patina::jobs {

struct BodySolution {
    rt::Reflection reflection;
    std::vector<brdf::OnceScattered> once_scattered;  // empty: the modes hold all
};

// Angles at which a table holds its specular part: half a degree apart from 0 to 90.
std::vector<double> specular_angles_deg();

// True when a layer's scattering function varies by more than `tolerance` of its mean beyond order 40, within some four
// degrees: then light scattered once has features that nodes and Fourier modes do not follow. It does not depend on the
// number of streams, so that solutions of different numbers differ by what streams do. Never for a statistical solver.
bool is_sharp(const rt::Solver& solver, const rt::Problem& problem, double tolerance);

// `tolerance` is the table's. Where the problem is sharp, the truncated problem is solved, its once scattered light
// taken away, and that of the whole matrices kept apart (rt/once_scattered.h).
BodySolution solve_body(const rt::Solver& solver, const rt::Problem& problem, const rt::SolveOptions& options,
                        double tolerance);

// The closed forms that belong to modes solved earlier.
std::vector<brdf::OnceScattered> once_scattered_of(const rt::Solver& solver, const rt::Problem& problem, int streams,
                                                   double tolerance);

}  // namespace patina::jobs
