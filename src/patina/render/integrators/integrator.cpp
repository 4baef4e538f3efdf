#include "patina/render/integrators/integrator.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/integrators/path.h"
#include "patina/render/plugins.h"

namespace patina::render {

std::unique_ptr<Integrator> build_integrator(const Properties& node) {
    expect_plugin(node);
    if (node.type == "stokes") {
        const auto inner = node.only_child("integrator");
        expect_known_properties(node);
        if (!inner) throw input_error(node.where, "the stokes integrator wraps another", "none is given");
        return build_integrator(*inner);
    }
    PathIntegrator::Settings settings;
    const auto at_least = [&](const char* name, std::int64_t fallback, std::int64_t least) {
        const std::int64_t value = node.integer(name, fallback);
        if (value < least || value > 1'000'000)
            throw input_error(node.location_of(name), fmt::format("{} out of range", name),
                              fmt::format("it is {}", value), fmt::format("keep it at {} or above", least));
        return static_cast<int>(value);
    };
    settings.max_depth = at_least("max_depth", -1, -1);
    settings.rr_depth = at_least("rr_depth", 5, 1);
    settings.hide_emitters = node.boolean("hide_emitters", false);
    expect_known_properties(node);
    return std::make_unique<PathIntegrator>(settings);
}

}  // namespace patina::render
