#include "patina/rt/monte_carlo/cones.h"

#include "patina/core/contract.h"

namespace patina::rt::monte_carlo {

Cone::Cone(const Stack& stack, const SpecularStack::Level& level, double cosine) : level_(level), cosine_(cosine) {
    PATINA_EXPECT(cosine > 0.0 && cosine <= 1.0);
    const SpecularStack specular(stack, stack.index(level.layer) * std::sqrt((1.0 - cosine) * (1.0 + cosine)));
    const SpecularStack::Importance importance = specular.importance(level);
    for (int l = 0; l < stack.size(); ++l) {
        const std::size_t i = static_cast<std::size_t>(l);
        const double mu = specular.mu(l);
        // Of an infinite layer nothing comes back from below.
        layers_.push_back({mu, mu > 0.0 ? 1.0 / mu : 0.0, stack.thickness(l), importance.up_at_top[i],
                           std::isinf(stack.thickness(l)) ? Gain{} : importance.down_at_bottom[i]});
    }
}

}  // namespace patina::rt::monte_carlo
