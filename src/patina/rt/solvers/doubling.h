#pragma once
// The default solver.

#include "patina/rt/solver.h"

namespace patina::rt {

class Doubling final : public Solver {
  public:
    std::string_view name() const override { return "doubling"; }
    std::string_view summary() const override;
    std::string unsupported(const Problem& problem) const override;
    Reflection reflection(const Problem& problem, const SolveOptions& options) const override;
    Field field(const Problem& problem, const FieldRequest& request, const SolveOptions& options) const override;
};

}  // namespace patina::rt
