#include "patina/render/indices.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/optics/materials.h"

namespace patina::render {

namespace {

// Media that Mitsuba scenes name, at the sodium line (the values of its manual's list of indices).
struct Medium {
    const char* name;
    double index;
};
constexpr Medium media[] = {{"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
                            {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
                            {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
                            {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
                            {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
                            {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
                            {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
                            {"pet", 1.5750},      {"diamond", 2.419}};

optics::OpticalConstants material(const std::string& name, const Properties& node, const std::string& property,
                                  const BsdfBuilder& builder) {
    const SourceLocation where = node.location_of(property);
    const optics::OpticalConstants constants =
        builder.resources->material ? builder.resources->material(name) : optics::builtin_material(name, where);
    if (!constants.covers(wavelength_min_nm) || !constants.covers(wavelength_max_nm))
        (*builder.notes)["extrapolated " + name] =
            fmt::format("the data span {:g} .. {:g} nm; held constant beyond", constants.wavelength_min_nm(),
                        constants.wavelength_max_nm());
    (*builder.notes)["material " + name] = constants.citation();
    return constants;
}

Spectrum part(const optics::OpticalConstants& constants, bool imaginary) {
    return Spectrum([&](double nm) {
        const auto m = constants.at(nm, optics::Extrapolation::hold);
        return imaginary ? m.imag() : m.real();
    });
}

Spectrum index_table(const SpectrumSpec& spec, const SourceLocation& where) {
    Spectrum spectrum = property_table(spec, where);
    if (!(spectrum.smallest() >= 0.1f && spectrum.largest() <= 10))
        throw input_error(where, "refractive index out of range",
                          fmt::format("it spans {} .. {}", spectrum.smallest(), spectrum.largest()),
                          "keep it between 0.1 and 10");
    return spectrum;
}

// n or k of a metal: far beyond any, and single precision holds its fourth power.
Spectrum metal_table(const SpectrumSpec& spec, const SourceLocation& where) {
    Spectrum spectrum = property_table(spec, where);
    if (!(spectrum.largest() <= 1e6f))
        throw input_error(where, "index of the metal out of range", fmt::format("it goes up to {}", spectrum.largest()),
                          "keep it at 1e6 or below");
    return spectrum;
}

bool is_string(const Properties& node, std::string_view name) {
    for (const auto& entry : node.entries)
        if (entry.name == name) return std::holds_alternative<std::string>(entry.value);
    return false;
}

}  // namespace

Spectrum real_index(const Properties& node, const std::string& name, std::string_view fallback,
                    const BsdfBuilder& builder) {
    if (node.has(name) && !is_string(node, name)) return index_table(*node.spectrum(name), node.location_of(name));
    const std::string medium = node.string(name, fallback);
    for (const Medium& known : media)
        if (known.name == medium) return Spectrum(static_cast<float>(known.index));
    return part(material(medium, node, name, builder), false);
}

ConductorIndex conductor_index(const Properties& node, const BsdfBuilder& builder) {
    const auto n = node.spectrum("eta"), k = node.spectrum("k");
    if (n || k) {
        if (!n || !k) throw input_error(node.where, "\"eta\" and \"k\" must be given together");
        return {metal_table(*n, node.location_of("eta")), metal_table(*k, node.location_of("k"))};
    }
    const std::string name = node.string("material", "Cu");
    if (name == "none") return {Spectrum(0.0f), Spectrum(1.0f)};
    const optics::OpticalConstants constants = material(name, node, "material", builder);
    return {part(constants, false), part(constants, true)};
}

}  // namespace patina::render
