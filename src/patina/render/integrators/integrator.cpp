#include "patina/render/integrators/integrator.h"

#include <algorithm>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/aov.h"
#include "patina/render/integrators/bidirectional.h"
#include "patina/render/integrators/path.h"
#include "patina/render/integrators/radiosity.h"
#include "patina/render/integrators/ray_tree.h"
#include "patina/render/integrators/volumetric.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

int at_least(const Properties& node, const char* name, std::int64_t fallback, std::int64_t least) {
    const std::int64_t value = node.integer(name, fallback);
    if (value < least || value > 1'000'000)
        throw input_error(node.location_of(name), fmt::format("{} out of range", name), fmt::format("it is {}", value),
                          fmt::format("keep it at {} or above", least));
    return static_cast<int>(value);
}

// Of Mitsuba's schedule of work; here the samples of a pixel follow one another anyway.
void accept_schedule(const Properties& node) {
    at_least(node, "samples_per_pass", 1, 1);
    at_least(node, "block_size", 0, 0);
}

// Where light does not fade, only roulette ends a path; begun earlier than asked for it changes no mean.
constexpr int latest_roulette = 256;

// What all integrators take.
template <class Settings>
Settings common_settings(const Properties& node, bool hide_emitters) {
    Settings settings;
    settings.max_depth = at_least(node, "max_depth", -1, -1);
    settings.rr_depth = std::min(at_least(node, "rr_depth", 5, 1), latest_roulette);
    settings.hide_emitters = node.boolean("hide_emitters", hide_emitters);
    accept_schedule(node);
    return settings;
}

std::unique_ptr<Integrator> ray_tree(const Properties& node) {
    const bool distribution = node.type == "distribution";
    auto settings = common_settings<RayTreeIntegrator::Settings>(node, !distribution);
    settings.follow_specular = node.type != "appel";
    settings.follow_glossy = distribution;
    settings.light_samples = at_least(node, "light_samples", distribution ? 4 : 1, 1);
    settings.lobe_samples = at_least(node, "lobe_samples", distribution ? 4 : 1, 1);
    return std::make_unique<RayTreeIntegrator>(settings);
}

std::unique_ptr<Integrator> bidirectional(const Properties& node) {
    auto settings = common_settings<BidirectionalIntegrator::Settings>(node, false);
    settings.light_only = node.type == "light" || node.type == "ptracer";
    return std::make_unique<BidirectionalIntegrator>(settings);
}

std::unique_ptr<Integrator> radiosity(const Properties& node) {
    RadiosityIntegrator::Settings settings;
    settings.patches = at_least(node, "patches", settings.patches, 1);
    settings.rays = at_least(node, "rays", settings.rays, 1);
    settings.gather = node.boolean("gather", true);
    settings.hide_emitters = node.boolean("hide_emitters", false);
    const std::vector<std::string> names = {"lu", "jacobi", "gauss_seidel", "neumann"};
    const std::string solver = node.string("solver", "lu");
    const auto found = std::find(names.begin(), names.end(), solver);
    if (found == names.end())
        throw input_error(node.location_of("solver"), fmt::format("unknown solver \"{}\"", solver), "",
                          did_you_mean(solver, names));
    settings.solver = static_cast<RadiosityIntegrator::Solver>(found - names.begin());
    return std::make_unique<RadiosityIntegrator>(settings);
}

std::unique_ptr<Integrator> direct(const Properties& node) {
    PathIntegrator::Settings settings;
    settings.max_depth = 2;
    settings.hide_emitters = node.boolean("hide_emitters", false);
    for (const char* name : {"shading_samples", "emitter_samples", "bsdf_samples"}) at_least(node, name, 1, 0);
    accept_schedule(node);
    return std::make_unique<PathIntegrator>(settings);
}

std::unique_ptr<Integrator> build_named(const Properties& node) {
    if (node.type == "appel" || node.type == "whitted" || node.type == "distribution") return ray_tree(node);
    if (node.type == "light" || node.type == "ptracer" || node.type == "bidirectional") return bidirectional(node);
    if (node.type == "radiosity") return radiosity(node);
    if (node.type == "direct") return direct(node);
    if (node.type == "volumetric" || node.type == "volpath" || node.type == "volpathmis")
        return std::make_unique<VolumetricIntegrator>(common_settings<VolumetricIntegrator::Settings>(node, false));
    return std::make_unique<PathIntegrator>(common_settings<PathIntegrator::Settings>(node, false));
}

}  // namespace

bool is_wrapper(const Properties& integrator) {
    return integrator.type == "stokes" || integrator.type == "aov" || integrator.type == "moment";
}

const Properties& wrapped_integrator(const Properties& integrator) {
    if (!is_wrapper(integrator)) return integrator;
    const auto inner = integrator.only_child("integrator");
    if (!inner)
        throw input_error(integrator.where, fmt::format("the {} integrator wraps another", integrator.type),
                          "none is given");
    return wrapped_integrator(*inner);
}

std::unique_ptr<Integrator> build_integrator(const Properties& node) {
    expect_plugin(node);
    if (is_wrapper(node)) {
        if (node.type == "aov") aovs_of(node);
        node.only_child("integrator");
        expect_known_properties(node);
        return build_integrator(wrapped_integrator(node));
    }
    auto integrator = build_named(node);
    expect_known_properties(node);
    return integrator;
}

}  // namespace patina::render
