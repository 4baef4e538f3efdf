#include "patina/render/medium_coefficients.h"

#include <algorithm>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

float at(const Spectrum& table, double nm) {
    return table.at(Wavelengths::all_at(static_cast<float>(nm)))[0];
}

// Straight lines between the wavelengths of a regular grid, its ends held outside.
template <class Value>
Spectrum interpolated(const optics::SpectralMedium& medium, const Value& value) {
    const auto last = static_cast<std::ptrdiff_t>(medium.media.size()) - 1;
    return Spectrum([&](double nm) {
        const double x = std::clamp((nm - medium.first_nm) / medium.step_nm, 0.0, static_cast<double>(last));
        const auto below = static_cast<std::ptrdiff_t>(x), above = std::min(below + 1, last);
        const double fraction = x - static_cast<double>(below);
        return (1 - fraction) * value(static_cast<std::size_t>(below)) +
               fraction * value(static_cast<std::size_t>(above));
    });
}

}  // namespace

Spectrum LayerInScene::spectrum(const std::function<double(const optics::ScatteringMedium&)>& value) const {
    return interpolated(*medium, [&](std::size_t i) { return value(medium->media[i]); });
}
Spectrum LayerInScene::host_index() const {
    return interpolated(*medium, [&](std::size_t i) { return medium->host_index[i]; });
}

LayerInScene layer_in_scene(const Properties& node, const SceneResources& resources,
                            std::map<std::string, std::string>& notes) {
    const std::string file = node.string("filename");
    const SourceLocation where = node.location_of("filename");
    if (!resources.load_medium) throw Error(ErrorKind::not_built, where.to_string() + ": recipes are not available");
    const std::int64_t layer = node.integer("layer", -1);
    if (layer < -1 || layer > 1000)
        throw input_error(node.location_of("layer"), "layer out of range", fmt::format("it is {}", layer),
                          "0 is the topmost; leave it out for the topmost that scatters");
    LayerInScene result;
    result.unit_um = node.number("scene_unit_um", 1);
    if (!(result.unit_um > 0) || !std::isfinite(result.unit_um))
        throw input_error(node.location_of("scene_unit_um"), "scene_unit_um must be positive",
                          fmt::format("it is {}", result.unit_um));
    result.medium = resources.load_medium(file, static_cast<int>(layer));
    const optics::SpectralMedium& medium = *result.medium;
    for (std::size_t i = 0; i < medium.notes.size(); ++i)
        notes[fmt::format("medium {} note {}", file, i)] = medium.notes[i];
    for (std::size_t i = 0; i < medium.citations.size(); ++i)
        notes[fmt::format("medium {} material {}", file, i)] = medium.citations[i];
    return result;
}

std::optional<GivenSpectrum> given_spectrum(const Properties& node, const char* name) {
    const auto volume = node.named_child(name);
    if (volume) expect_plugin(*volume);
    const Properties& holder = volume ? *volume : node;
    const char* key = volume ? "value" : name;
    auto spec = holder.spectrum(key);
    if (volume) expect_known_properties(*volume);
    if (!spec && volume) spec = SpectrumSpec{SpectrumSpec::Kind::uniform, {}, {1.0}};
    if (!spec) return std::nullopt;
    return GivenSpectrum{*spec, holder.location_of(key)};
}

Spectrum coefficient(const Properties& node, const char* name, float fallback) {
    const auto given = given_spectrum(node, name);
    if (!given) return Spectrum(fallback);
    const Spectrum table = property_table(given->spec, given->where);
    if (!(table.smallest() >= 0) || !std::isfinite(table.largest()))
        throw input_error(given->where, fmt::format("{} must not be negative", name),
                          fmt::format("it goes from {} to {}", table.smallest(), table.largest()));
    return table;
}

double factor(const Properties& node, const char* name) {
    const double value = node.number(name, 1);
    if (!(value >= 0) || !std::isfinite(value))
        throw input_error(node.location_of(name), fmt::format("{} must not be negative", name),
                          fmt::format("it is {}", value));
    return value;
}

Spectrum scaled(const Spectrum& table, double factor) {
    return Spectrum([&](double nm) { return factor * at(table, nm); });
}

ReducedCoefficients reduced_coefficients(const Properties& node, const SceneResources& resources,
                                         std::map<std::string, std::string>& notes) {
    ReducedCoefficients result;
    const double scale = factor(node, "scale");
    if (node.has("filename")) {
        for (const char* name : {"sigma_a", "sigma_s", "g"})
            if (node.has(name))
                throw input_error(node.location_of(name), fmt::format("{} is the recipe's", name),
                                  "a recipe is given as well", "leave one of them out");
        const LayerInScene layer = layer_in_scene(node, resources, notes);
        const double unit = scale * layer.unit_um;
        result.absorption =
            layer.spectrum([&](const optics::ScatteringMedium& m) { return unit * m.absorption_per_um; });
        result.scattering = layer.spectrum(
            [&](const optics::ScatteringMedium& m) { return unit * m.scattering_per_um * (1 - m.asymmetry()); });
        result.index = layer.host_index();
    } else {
        const double g = node.number("g", 0);
        if (!(std::abs(g) < 1))
            throw input_error(node.location_of("g"), "mean cosine out of range", fmt::format("it is {}", g),
                              "keep it above -1 and below 1");
        result.absorption = scaled(coefficient(node, "sigma_a", 0.1f), scale);
        result.scattering = scaled(coefficient(node, "sigma_s", 10.0f), scale * (1 - g));
    }
    if (!(result.scattering.smallest() > 0))
        throw input_error(node.where, "a dipole needs scattering at every wavelength", "sigma_s (1 - g) goes down to 0",
                          "use a dielectric with a medium inside");
    return result;
}

}  // namespace patina::render
