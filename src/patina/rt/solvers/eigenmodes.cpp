#include "patina/rt/solvers/eigenmodes.h"

#include "patina/rt/solvers/eigenmode_layer.h"
#include "patina/rt/stack.h"

namespace patina::rt {

std::string_view Eigenmodes::summary() const {
    return "discrete ordinates by eigenmodes of each Fourier order (Collin et al. 2014)";
}

Reflection Eigenmodes::reflection(const Problem& problem, const SolveOptions& options) const {
    return solve_reflection(problem, options, EigenmodeMethod{});
}

Field Eigenmodes::field(const Problem& problem, const FieldRequest& request, const SolveOptions& options) const {
    return solve_field(problem, request, options, EigenmodeMethod{});
}

}  // namespace patina::rt
