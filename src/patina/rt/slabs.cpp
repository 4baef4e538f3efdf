#include "patina/rt/slabs.h"

#include <algorithm>

namespace patina::rt {

Levels cut(const Problem& problem, const std::vector<double>& depths) {
    Levels result;
    result.of_depth.assign(depths.size(), 0);
    std::vector<std::size_t> by_depth(depths.size());
    for (std::size_t d = 0; d < depths.size(); ++d) by_depth[d] = d;
    std::sort(by_depth.begin(), by_depth.end(), [&](std::size_t a, std::size_t b) { return depths[a] < depths[b]; });

    std::size_t next = 0;
    double top = 0.0;
    while (next < by_depth.size() && depths[by_depth[next]] == 0.0) ++next;
    for (int k = 0; k < static_cast<int>(problem.layers.size()); ++k) {
        const double bottom = top + problem.layers[k].optical_thickness;
        const bool last = k + 1 == static_cast<int>(problem.layers.size());
        double from = top;
        for (; next < by_depth.size() && (last || depths[by_depth[next]] <= bottom); ++next) {
            const double depth = std::min(depths[by_depth[next]], bottom);
            if (depth > from) result.slabs.push_back({k, depth - from});
            from = std::max(from, depth);
            result.of_depth[by_depth[next]] = static_cast<int>(result.slabs.size());
        }
        if (bottom > from || problem.layers[k].optical_thickness == 0.0) result.slabs.push_back({k, bottom - from});
        top = bottom;
    }
    return result;
}

}  // namespace patina::rt
