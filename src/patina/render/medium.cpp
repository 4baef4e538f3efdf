#include "patina/render/medium.h"

#include <algorithm>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/medium_coefficients.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

struct PhaseEntry {
    PluginDescriptor descriptor;
    Phase (*build)(const Properties&, const PhaseBuilder&);
};

template <class... Models>
std::vector<PhaseEntry> entries_of(std::variant<Models...>*) {
    return {PhaseEntry{Models::describe(), [](const Properties& node, const PhaseBuilder& builder) {
                           return Phase{Models::build(node, builder)};
                       }}...};
}

Phase build_phase(const Properties& node, const PhaseBuilder& builder) {
    const std::string& name = expect_plugin(node).name;
    for (const PhaseEntry& entry : entries_of(static_cast<Phase*>(nullptr))) {
        if (entry.descriptor.name != name) continue;
        Phase phase = entry.build(node, builder);
        expect_known_properties(node);
        return phase;
    }
    throw input_error(node.where, fmt::format("\"{}\" is no phase function", node.type));
}

// Extinction and albedo as sigma_t and albedo, or as sigma_a and sigma_s.
void read_coefficients(const Properties& node, Medium& medium) {
    const auto given = [&](const char* name) { return given_spectrum(node, name).has_value(); };
    const bool by_parts = given("sigma_a") || given("sigma_s");
    if (by_parts && (given("sigma_t") || given("albedo")))
        throw input_error(node.where, "a medium is given by sigma_t and albedo or by sigma_a and sigma_s",
                          "both are given", "leave one pair out");
    if (!by_parts) {
        medium.extinction = coefficient(node, "sigma_t", 1);
        medium.albedo = Spectrum(0.75f);
        if (const auto albedo = given_spectrum(node, "albedo"))
            medium.albedo = reflectance_table(albedo->spec, albedo->where);
        return;
    }
    const Spectrum absorption = coefficient(node, "sigma_a", 0);
    const Spectrum scattering = coefficient(node, "sigma_s", 0);
    const auto at = [](const Spectrum& table, double nm) {
        return static_cast<double>(table.at(Wavelengths::all_at(static_cast<float>(nm)))[0]);
    };
    medium.extinction = Spectrum([&](double nm) { return at(absorption, nm) + at(scattering, nm); });
    medium.albedo = Spectrum([&](double nm) {
        const double total = at(absorption, nm) + at(scattering, nm);
        return total > 0 ? at(scattering, nm) / total : 0.0;
    });
}

Medium homogeneous(const Properties& node, const PhaseBuilder& builder) {
    Medium medium;
    read_coefficients(node, medium);
    medium.extinction = scaled(medium.extinction, factor(node, "scale"));
    if (const auto phase = node.only_child("phase")) medium.phase = build_phase(*phase, builder);
    return medium;
}

// A layer of a recipe, in units of the scene.
Medium paint(const Properties& node, const PhaseBuilder& builder) {
    const LayerInScene layer = layer_in_scene(node, *builder.resources, *builder.notes);
    Medium medium;
    const double scale = layer.unit_um * factor(node, "scale");
    medium.extinction = layer.spectrum([&](const optics::ScatteringMedium& m) { return scale * m.extinction_per_um; });
    medium.albedo = layer.spectrum([](const optics::ScatteringMedium& m) { return std::min(1.0, m.albedo()); });
    std::vector<optics::ExpansionCoefficients> expansions;
    for (const optics::ScatteringMedium& m : layer.medium->media) expansions.push_back(m.expansion);
    medium.phase =
        MiePhase{std::make_shared<const PhaseTable>(expansions, layer.medium->first_nm, layer.medium->step_nm)};
    return medium;
}

}  // namespace

std::vector<PluginDescriptor> medium_descriptors() {
    std::vector<PluginDescriptor> all;
    all.push_back({"medium",
                   "homogeneous",
                   "The same everywhere; takes one phase function (isotropic without).",
                   {{"sigma_t", "spectrum", "1/scene unit", "1", ">= 0", "extinction"},
                    {"albedo", "spectrum", "", "0.75", "0 .. 1", "scattered share of the extinction"},
                    {"sigma_a", "spectrum", "1/scene unit", "0", ">= 0", "absorption, with sigma_s instead of both"},
                    {"sigma_s", "spectrum", "1/scene unit", "0", ">= 0", "scattering"},
                    {"scale", "number", "", "1", ">= 0", "factor on the coefficients"}}});
    all.push_back({"medium",
                   "paint",
                   "A layer of a recipe without its surfaces and its thickness: particles in the binder.",
                   {{"filename", "path", "", "", "", "the recipe (.toml)"},
                    {"layer", "integer", "", "the topmost that scatters", ">= 0", "which, counted from the top"},
                    {"scene_unit_um", "number", "um", "1", "> 0", "what a unit of length of the scene stands for"},
                    {"scale", "number", "", "1", ">= 0", "factor on the coefficients"}}});
    for (PhaseEntry& entry : entries_of(static_cast<Phase*>(nullptr))) all.push_back(std::move(entry.descriptor));
    return all;
}

Medium build_medium(const Properties& node, const PhaseBuilder& builder) {
    expect_plugin(node);
    Medium medium = node.type == "paint" ? paint(node, builder) : homogeneous(node, builder);
    expect_known_properties(node);
    return medium;
}

}  // namespace patina::render
