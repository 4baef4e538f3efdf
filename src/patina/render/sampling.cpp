#include "patina/render/sampling.h"

#include "patina/core/contract.h"

namespace patina::render {

DiscreteDistribution::DiscreteDistribution(std::span<const double> weights) {
    PATINA_EXPECT(!weights.empty());
    cumulative_.resize(weights.size() + 1);
    std::vector<double> sums(weights.size() + 1, 0.0);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        PATINA_EXPECT(weights[i] >= 0);
        sums[i + 1] = sums[i] + weights[i];
    }
    total_ = sums.back();
    PATINA_EXPECT(total_ > 0);
    for (std::size_t i = 0; i < sums.size(); ++i) cumulative_[i] = static_cast<float>(sums[i] / total_);
}

DiscreteDistribution::Choice DiscreteDistribution::sample(float u) const {
    if (size() == 1) return {0, 1.0f, u};
    // The last entry that begins at or before u, never one of weight zero.
    const auto upper = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, u);
    int index = static_cast<int>(upper - cumulative_.begin()) - 1;
    while (index > 0 && probability(index) <= 0) --index;
    while (probability(index) <= 0) ++index;
    const float p = probability(index);
    return {index, p, std::clamp((u - cumulative_[index]) / p, 0.0f, 0x1.fffffep-1f)};
}

}  // namespace patina::render
