#include "patina/rt/solvers/doubling.h"

#include "patina/rt/solvers/tanh_doubling.h"
#include "patina/rt/stack.h"

namespace patina::rt {

std::string_view Doubling::summary() const {
    return "adding and tanh doubling: every albedo and thickness, conservative and semi-infinite layers included";
}

std::string Doubling::unsupported(const Problem&) const {
    return {};
}

Reflection Doubling::reflection(const Problem& problem, const SolveOptions& options) const {
    return solve_reflection(problem, options, DoublingMethod{});
}

Field Doubling::field(const Problem& problem, const FieldRequest& request, const SolveOptions& options) const {
    return solve_field(problem, request, options, DoublingMethod{});
}

}  // namespace patina::rt
