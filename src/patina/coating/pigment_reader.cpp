#include "patina/coating/pigment_reader.h"

#include <array>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/coating/concentration.h"
#include "patina/coating/scattering_csv.h"
#include "patina/coating/size_reader.h"

namespace patina::coating {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_pigments = 100;
constexpr double densest_packing = 0.74;  // of equal spheres; more cannot be meant

// The text of a key as a file that is there.
fs::path file_of(const TableReader& reader, std::string_view key, const Context& context) {
    const fs::path file = context.folder / reader.text(key);
    std::error_code ignored;
    if (!fs::exists(file, ignored))
        throw input_error(reader.where(key), fmt::format("{}: file not found", file.string()));
    return file;
}

optics::ExternalParticles read_external(const TableReader& reader, const Context& context) {
    static constexpr std::array<std::string_view, 4> sphere_keys{"material", "material_ordinary",
                                                                 "material_extraordinary", "size"};
    static constexpr std::array<std::string_view, 2> numbers{"extinction_um2", "scattering_um2"};
    static constexpr std::array<std::string_view, 1> expansion_key{"expansion"};
    reader.forbid(sphere_keys, "matrix or expansion says how the particles scatter");
    const bool by_matrix = reader.has("matrix");
    if (by_matrix) reader.forbid(expansion_key, "matrix says it");
    const fs::path file = file_of(reader, by_matrix ? "matrix" : "expansion", context);

    optics::ExternalParticles particles;
    particles.name = file.filename().string();
    particles.volume_um3 = reader.number("particle_volume_um3");
    particles.laws = by_matrix ? read_matrix_csv(file) : read_expansion_csv(file);
    if (reader.has("cross_sections")) {
        reader.forbid(numbers, "the file of cross_sections gives it");
        particles.cross_sections = read_cross_sections_csv(file_of(reader, "cross_sections", context));
        return particles;
    }
    const double extinction = reader.number("extinction_um2"), scattering = reader.number("scattering_um2");
    if (scattering > extinction)
        throw input_error(reader.where("scattering_um2"),
                          fmt::format("{} = {:g} exceeds extinction_um2 = {:g}", reader.path_of("scattering_um2"),
                                      scattering, extinction),
                          "extinction is scattering and absorption");
    particles.cross_sections = {{0.0, extinction, scattering}};
    return particles;
}

Spheres read_spheres(const TableReader& reader, const Context& context) {
    static constexpr std::array<std::string_view, 4> external_keys{"cross_sections", "extinction_um2", "scattering_um2",
                                                                   "particle_volume_um3"};
    static constexpr std::array<std::string_view, 1> material_key{"material"};
    reader.forbid(external_keys, "it belongs to particles with a matrix or an expansion; spheres are computed");
    const bool birefringent = reader.has("material_ordinary") || reader.has("material_extraordinary");
    if (birefringent) reader.forbid(material_key, "the materials of the ordinary and the extraordinary ray are given");
    const toml::table* size = reader.table("size");
    if (!size)
        throw input_error(reader.where(), fmt::format("{} is missing", reader.path_of("size")), "",
                          "write size = { distribution = \"mono\", radius_um = 0.2 }");
    Spheres spheres{
        read_material(reader, birefringent ? "material_ordinary" : "material", context),
        read_size_distribution(TableReader(*size, recipe_keys("size"), reader.path_of("size"), context.file)),
        std::nullopt};
    if (birefringent) spheres.extraordinary = read_material(reader, "material_extraordinary", context);
    return spheres;
}

double mean_volume_um3(const Pigment& pigment) {
    if (const auto* spheres = std::get_if<Spheres>(&pigment.particles)) return optics::mean_volume_um3(spheres->size);
    return std::get<optics::ExternalParticles>(pigment.particles).volume_um3;
}

std::string_view key_of_concentration(const TableReader& reader) {
    std::string_view found;
    for (const std::string_view key : concentration_keys) {
        if (!reader.has(key)) continue;
        if (!found.empty())
            throw input_error(reader.where(key), fmt::format("{} beside {}", reader.path_of(key), found),
                              "a pigment has one concentration", fmt::format("leave {} or {} out", found, key));
        found = key;
    }
    if (found.empty())
        throw input_error(reader.where(), fmt::format("{} is missing", reader.path_of("volume_fraction")),
                          fmt::format("a pigment has one of {}", fmt::join(concentration_keys, ", ")));
    return found;
}

Concentration read_concentration(const TableReader& reader, const Pigment& pigment) {
    static constexpr ConcentrationKind kinds[] = {ConcentrationKind::volume_fraction, ConcentrationKind::pvc_percent,
                                                  ConcentrationKind::weight_percent,
                                                  ConcentrationKind::number_density_um3};
    const std::string_view key = key_of_concentration(reader);
    const auto index = std::find(std::begin(concentration_keys), std::end(concentration_keys), key);
    Concentration concentration{kinds[index - std::begin(concentration_keys)], reader.number(key), 0.0,
                                reader.optional_number("density_g_cm3")};
    if (concentration.kind == ConcentrationKind::number_density_um3)
        concentration.mean_particle_volume_um3 = mean_volume_um3(pigment);
    return concentration;
}

// Weights need densities, of everything in the film, and leave something for the binder.
void check_weights(const std::vector<Concentration>& pigments, const TableReader& layer,
                   const std::vector<TableReader>& readers) {
    constexpr std::string_view weighed =
        "weight_percent is of the mass of the dry film, which takes the density of all that is in it";
    double percent = 0.0;
    for (const Concentration& pigment : pigments)
        if (pigment.kind == ConcentrationKind::weight_percent) percent += pigment.value;
    if (percent == 0.0) return;
    if (percent >= 100.0)
        throw input_error(layer.where("pigments"), fmt::format("the weights add up to {:g} %", percent),
                          "something has to be left for the binder");
    if (!layer.has("binder_density_g_cm3"))
        throw input_error(layer.where(), fmt::format("{} is missing", layer.path_of("binder_density_g_cm3")), weighed);
    for (std::size_t i = 0; i < pigments.size(); ++i)
        if (!pigments[i].density_g_cm3)
            throw input_error(readers[i].where(), fmt::format("{} is missing", readers[i].path_of("density_g_cm3")),
                              weighed);
}

void expect_room(double fraction, const SourceLocation& where, const std::string& what) {
    if (fraction <= densest_packing) return;
    throw input_error(where, fmt::format("the volume fractions{} add up to {:g}", what, fraction),
                      fmt::format("spheres fill at most {}", densest_packing));
}

}  // namespace

std::vector<Pigment> read_pigments(const TableReader& layer, const Context& context) {
    const std::vector<const toml::table*> tables = layer.tables("pigments");
    if (tables.size() > most_pigments)
        throw input_error(layer.where("pigments"), fmt::format("{} pigments", tables.size()),
                          fmt::format("at most {} make sense", most_pigments));
    std::vector<TableReader> readers;
    std::vector<Pigment> pigments;
    std::vector<Concentration> concentrations;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const TableReader& reader =
            readers.emplace_back(*tables[i], recipe_keys("[[layers.pigments]]"),
                                 fmt::format("{}.{}", layer.path_of("pigments"), i), context.file);
        if (reader.has("matrix") || reader.has("expansion"))
            pigments.push_back({0.0, read_external(reader, context)});
        else
            pigments.push_back({0.0, read_spheres(reader, context)});
        concentrations.push_back(read_concentration(reader, pigments.back()));
    }

    // Only what is not given by weight can fill too much by itself.
    check_weights(concentrations, layer, readers);
    std::vector<Concentration> others = concentrations;
    std::erase_if(others, [](const Concentration& c) { return c.kind == ConcentrationKind::weight_percent; });
    const auto total = [](const std::vector<double>& fractions) {
        return std::accumulate(fractions.begin(), fractions.end(), 0.0);
    };
    expect_room(total(volume_fractions(others, std::nullopt)), layer.where("pigments"), "");
    const std::vector<double> fractions =
        volume_fractions(concentrations, layer.optional_number("binder_density_g_cm3"));
    expect_room(total(fractions), layer.where("pigments"), others.size() < pigments.size() ? " by weight" : "");
    for (std::size_t i = 0; i < pigments.size(); ++i) pigments[i].volume_fraction = fractions[i];
    return pigments;
}

const std::string& Pigment::name() const {
    if (const auto* spheres = std::get_if<Spheres>(&particles)) return spheres->material.name();
    return std::get<optics::ExternalParticles>(particles).name;
}

}  // namespace patina::coating
