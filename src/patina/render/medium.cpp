#include "patina/render/medium.h"

#include <fmt/format.h>

#include "patina/core/error.h"
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

double positive_or_zero(const Properties& node, const char* name, double fallback) {
    const double value = node.number(name, fallback);
    if (!(value >= 0) || !std::isfinite(value))
        throw input_error(node.location_of(name), fmt::format("{} must not be negative", name),
                          fmt::format("it is {}", value));
    return value;
}

// A coefficient per length, 0 .. infinity exclusive.
Spectrum coefficient(const Properties& node, const char* name) {
    const Spectrum table = property_table(*node.spectrum(name), node.location_of(name));
    if (!(table.smallest() >= 0) || !std::isfinite(table.largest()))
        throw input_error(node.location_of(name), fmt::format("{} must not be negative", name),
                          fmt::format("it goes down to {}", table.smallest()));
    return table;
}

Spectrum scaled(const Spectrum& table, double factor) {
    return Spectrum([&](double nm) { return factor * table.at(Wavelengths::all_at(static_cast<float>(nm)))[0]; });
}

// Extinction and albedo as sigma_t and albedo, or as sigma_a and sigma_s.
void read_coefficients(const Properties& node, Medium& medium) {
    const bool by_parts = node.has("sigma_a") || node.has("sigma_s");
    if (by_parts && (node.has("sigma_t") || node.has("albedo")))
        throw input_error(node.where, "a medium is given by sigma_t and albedo or by sigma_a and sigma_s",
                          "both are given", "leave one pair out");
    if (!by_parts) {
        medium.extinction = node.has("sigma_t") ? coefficient(node, "sigma_t") : Spectrum(1.0f);
        medium.albedo = Spectrum(0.75f);
        if (const auto albedo = node.spectrum("albedo"))
            medium.albedo = reflectance_table(*albedo, node.location_of("albedo"));
        return;
    }
    const Spectrum absorption = node.has("sigma_a") ? coefficient(node, "sigma_a") : Spectrum(0.0f);
    const Spectrum scattering = node.has("sigma_s") ? coefficient(node, "sigma_s") : Spectrum(0.0f);
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
    medium.extinction = scaled(medium.extinction, positive_or_zero(node, "scale", 1));
    if (const auto phase = node.only_child("phase")) medium.phase = build_phase(*phase, builder);
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
    for (PhaseEntry& entry : entries_of(static_cast<Phase*>(nullptr))) all.push_back(std::move(entry.descriptor));
    return all;
}

Medium build_medium(const Properties& node, const PhaseBuilder& builder) {
    expect_plugin(node);
    Medium medium = homogeneous(node, builder);
    expect_known_properties(node);
    return medium;
}

}  // namespace patina::render
