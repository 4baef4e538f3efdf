#pragma once
// The answers of a solver for a whole stack, for any way of solving one layer.

#include "patina/rt/layer_operators.h"
#include "patina/rt/solver.h"

namespace patina::rt {

Reflection solve_reflection(const Problem& problem, const SolveOptions& options, const LayerMethod& method);
Field solve_field(const Problem& problem, const FieldRequest& request, const SolveOptions& options,
                  const LayerMethod& method);

}  // namespace patina::rt
