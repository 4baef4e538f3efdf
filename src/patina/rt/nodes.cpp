#include "patina/rt/nodes.h"

#include <algorithm>
#include <cmath>

#include "patina/core/contract.h"
#include "patina/math/quadrature.h"

namespace patina::rt {

double Ray::cosine_in(double n) const {
    if (n == index) return cosine;
    const double squared = (n - index) * (n + index) + index * index * cosine * cosine;
    // Rounding may carry the normal beyond itself.
    return squared > 0.0 ? std::min(std::sqrt(squared) / n, 1.0) : 0.0;
}

std::vector<Ray> quadrature_rays(const Problem& problem, int streams) {
    PATINA_EXPECT(streams >= 1);
    std::vector<double> indices{problem.refractive_index_above};
    for (const Layer& layer : problem.layers) indices.push_back(layer.refractive_index);
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());

    std::vector<Ray> rays;
    double previous = 0.0;
    for (double n : indices) {
        // Cover the rays that exist in this medium and in none of lower index.
        const double upper = std::sqrt((n - previous) * (n + previous)) / n;
        const int count = std::max(2, static_cast<int>(std::ceil(streams * upper - 1e-12)));
        const math::Quadrature rule = math::gauss_legendre(previous == 0.0 ? streams : count, 0.0, upper);
        for (int i = 0; i < rule.size(); ++i)
            rays.push_back({rule.nodes[i], n, n * n * rule.nodes[i] * rule.weights[i], Role::quadrature});
        previous = n;
    }
    return rays;
}

Medium medium_of(const std::vector<Ray>& rays, double index) {
    Medium medium;
    medium.index = index;
    std::vector<double> mu;
    for (int i = 0; i < static_cast<int>(rays.size()); ++i) {
        const double cosine = rays[i].cosine_in(index);
        if (cosine <= 0.0) continue;
        medium.rays.push_back(i);
        medium.roles.push_back(rays[i].role);
        mu.push_back(cosine);
    }
    medium.mu = Eigen::Map<const Eigen::VectorXd>(mu.data(), mu.size());
    medium.scale.resize(medium.size());
    for (int i = 0; i < medium.size(); ++i) medium.scale[i] = std::sqrt(rays[medium.rays[i]].flux_weight) / index;
    return medium;
}

}  // namespace patina::rt
