#pragma once
// Discrete ordinates: the transfer equation of each Fourier order through its eigenmodes.

#include "patina/rt/solver.h"

namespace patina::rt {

class Eigenmodes final : public Solver {
  public:
    // Two eigenvalues of a conservative layer meet at 0 and their eigenvectors with them: the error of the reflection
    // grows as 1e-16/(1 - albedo) times some 10^3 while the flux stays balanced, so nothing would tell.
    static constexpr double largest_albedo = 0.9999;

    std::string_view name() const override { return "eigenmodes"; }
    std::string_view summary() const override;
    std::string unsupported(const Problem& problem) const override;
    Reflection reflection(const Problem& problem, const SolveOptions& options) const override;
    Field field(const Problem& problem, const FieldRequest& request, const SolveOptions& options) const override;
};

}  // namespace patina::rt
