#include "patina/core/contract.h"
#include "patina/optics/fresnel.h"
#include "patina/rt/boundary.h"
#include "patina/rt/solver.h"

namespace patina::rt {

optics::Mueller specular_surface(const Problem& problem, double mu) {
    PATINA_EXPECT(mu >= 0.0 && mu <= 1.0);
    const double below = problem.layers.front().refractive_index;
    // What a rough surface reflects is no delta and stands among the modes.
    if (below == problem.refractive_index_above || problem.has_rough_top()) return optics::Mueller::Zero();
    return optics::fresnel_reflection(mu, problem.refractive_index_above, below);
}

optics::Mueller specular_coherent(const Problem& problem, double mu) {
    PATINA_EXPECT(mu >= 0.0 && mu <= 1.0);
    return coherent_reflection(problem, {mu, problem.refractive_index_above, 1.0, Role::beam});
}

}  // namespace patina::rt
