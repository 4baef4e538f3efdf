#include "patina/rt/once_scattered.h"

#include <algorithm>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/rt/single_scattering.h"

namespace patina::rt {

namespace {

using optics::ExpansionCoefficients;

constexpr std::vector<double> ExpansionCoefficients::*all_coefficients[] = {
    &ExpansionCoefficients::alpha1, &ExpansionCoefficients::alpha2, &ExpansionCoefficients::alpha3,
    &ExpansionCoefficients::alpha4, &ExpansionCoefficients::beta1,  &ExpansionCoefficients::beta2};

// omega S_l of a layer of the scaled stack.
ExpansionCoefficients kept(const Layer& layer) {
    ExpansionCoefficients result = layer.expansion;
    for (const auto list : all_coefficients)
        for (double& value : result.*list) value *= layer.single_scattering_albedo;
    return result;
}

bool scatters(const Layer& layer) {
    return layer.optical_thickness > 0.0 && layer.single_scattering_albedo > 0.0;
}

}  // namespace

std::vector<OnceScatteredLayer> once_scattered(const Truncation& truncation, const std::vector<double>& mu) {
    const Problem& problem = truncation.scaled;
    const double above = problem.refractive_index_above;
    std::vector<OnceScatteredLayer> result;
    for (std::size_t k = 0; k < problem.layers.size(); ++k) {
        const Layer& layer = problem.layers[k];
        if (!scatters(layer)) continue;
        OnceScatteredLayer once{layer.refractive_index / above, layer.optical_thickness, truncation.lacking[k], {}, {}};
        const ExpansionCoefficients rest = kept(layer);
        for (const auto list : all_coefficients) {
            std::vector<double>& whole = once.scattering.*list;
            whole.resize(std::max<std::size_t>({whole.size(), (rest.*list).size(), 3}), 0.0);
            for (std::size_t l = 0; l < (rest.*list).size(); ++l) whole[l] += (rest.*list)[l];
        }
        for (const double cosine : mu) {
            const RayPath path(problem, cut(problem, {}).slabs, {.cosine = cosine, .index = above}, false);
            const RayLight light = path.unscattered();
            once.down.push_back(light.down[k]);
            once.up.push_back(light.up[k]);
        }
        result.push_back(std::move(once));
    }
    return result;
}

void subtract_once_scattered(const Truncation& truncation, int streams, Reflection& reflection,
                             const CancelToken* cancel) {
    Truncation single{truncation.scaled, truncation.forward, {}, 0};
    single.lacking.resize(truncation.forward.size());
    for (std::size_t k = 0; k < truncation.forward.size(); ++k) {
        if (!scatters(truncation.scaled.layers[k])) continue;
        single.lacking[k] = kept(truncation.scaled.layers[k]);
        single.order = std::max(single.order, single.lacking[k].order());
    }
    single.order = std::max(single.order, 1);
    const StackMedia media(single.scaled, quadrature_rays(single.scaled, streams), streams, 0, cancel);
    const SingleScattering scattering(media, single, cut(single.scaled, {}).slabs, false);
    const Medium& medium = media.above;
    PATINA_EXPECT(medium.size() == static_cast<int>(reflection.mu.size()));
    std::vector<int> place(medium.size());
    for (int a = 0; a < medium.size(); ++a)
        place[a] = static_cast<int>(std::lower_bound(reflection.mu.begin(), reflection.mu.end(), medium.mu[a]) -
                                    reflection.mu.begin());

    const Eigen::Vector4d delta(1, 1, -1, -1);
    for (int m = 0; m < std::min<int>(single.order + 1, static_cast<int>(reflection.modes.size())); ++m) {
        Eigen::MatrixXd once = Eigen::MatrixXd::Zero(4 * medium.size(), 4 * medium.size());
        scattering.add_reflection(m, once);
        for (int i = 0; i < medium.size(); ++i)
            for (int o = 0; o < medium.size(); ++o)
                reflection.modes[m].block<4, 4>(4 * place[o], 4 * place[i]) -=
                    delta.asDiagonal() * once.block<4, 4>(4 * o, 4 * i) /
                    (2.0 * pi * medium.scale[o] * medium.scale[i]);
    }
}

}  // namespace patina::rt
