#pragma once
// Discrete ordinates: the transfer equation of each Fourier order through its eigenmodes.

#include "patina/rt/solver.h"

namespace patina::rt {

class Eigenmodes final : public Solver {
  public:
    std::string_view name() const override { return "eigenmodes"; }
    std::string_view summary() const override;
    std::string unsupported(const Problem&) const override { return {}; }
    Reflection reflection(const Problem& problem, const SolveOptions& options) const override;
    Field field(const Problem& problem, const FieldRequest& request, const SolveOptions& options) const override;
};

}  // namespace patina::rt
