#pragma once
// Fields at as many quadrature nodes as they need, and at any number of views.

#include "patina/rt/solver.h"

namespace patina::jobs {

// The field of a request with options.streams nodes. Views enlarge a deterministic solver's operators, whose cost grows
// with the cube, so that many are solved some at a time.
rt::Field field_of_views(const rt::Solver& solver, const rt::Problem& problem, const rt::FieldRequest& request,
                         const rt::SolveOptions& options);

// The field with nodes enough for the digits of printed tables: phase functions of up to 128 terms exactly. Sharper
// ones are truncated, with exact single scattering, and then far fewer nodes do than their terms ask for: as many as
// leave 5e-6 of the largest radiance, by the fall of the differences, 72 at most. A note tells when more is left.
// options.streams is not used.
rt::Field converged_field(const rt::Solver& solver, const rt::Problem& problem, const rt::FieldRequest& request,
                          rt::SolveOptions options);

}  // namespace patina::jobs
