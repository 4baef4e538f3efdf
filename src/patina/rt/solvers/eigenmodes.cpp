#include "patina/rt/solvers/eigenmodes.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/rt/solvers/eigenmode_layer.h"
#include "patina/rt/stack.h"

namespace patina::rt {

namespace {

void require_supported(const Eigenmodes& solver, const Problem& problem) {
    const std::string reason = solver.unsupported(problem);
    if (!reason.empty())
        throw input_error(SourceLocation{}, "solver eigenmodes cannot solve this problem", reason,
                          "use solver doubling");
}

}  // namespace

std::string_view Eigenmodes::summary() const {
    return "discrete ordinates by eigenmodes of each Fourier order (Collin et al. 2014); albedo at most 0.9999";
}

std::string Eigenmodes::unsupported(const Problem& problem) const {
    for (std::size_t k = 0; k < problem.layers.size(); ++k)
        if (problem.layers[k].single_scattering_albedo > largest_albedo)
            return fmt::format(
                "layer {} has a single-scattering albedo of {}, above {} the eigenmodes lose their accuracy", k,
                problem.layers[k].single_scattering_albedo, largest_albedo);
    return {};
}

Reflection Eigenmodes::reflection(const Problem& problem, const SolveOptions& options) const {
    require_supported(*this, problem);
    return solve_reflection(problem, options, EigenmodeMethod{});
}

Field Eigenmodes::field(const Problem& problem, const FieldRequest& request, const SolveOptions& options) const {
    require_supported(*this, problem);
    return solve_field(problem, request, options, EigenmodeMethod{});
}

}  // namespace patina::rt
