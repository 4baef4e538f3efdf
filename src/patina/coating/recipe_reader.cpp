#include <sstream>

#include <fmt/format.h>

#include "patina/coating/material_reader.h"
#include "patina/coating/pigment_reader.h"
#include "patina/coating/recipe.h"
#include "patina/coating/scattering_csv.h"
#include "patina/coating/table_reader.h"
#include "patina/core/files.h"
#include "patina/spectral/spectrum_file.h"

namespace patina::coating {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_layers = 1000;
constexpr int most_nested_recipes = 8;
constexpr std::uint64_t largest_recipe = std::uint64_t{16} << 20;

Recipe read_recipe_at(const fs::path& path, int depth);

Composition read_composition(const TableReader& reader, const Context& context) {
    static constexpr std::string_view optical_keys[] = {"single_scattering_albedo", "expansion", "matrix",
                                                        "refractive_index"};
    reader.forbid(optical_keys,
                  "the layer is given by its composition; an optical layer starts with optical_thickness");

    Composition composition{
        reader.number("thickness_um"), read_material(reader, "binder", context), {}, Packing::automatic, {}};
    const std::string packing = reader.choice("packing", {"auto", "percus-yevick", "independent"});
    if (packing == "percus-yevick") composition.packing = Packing::percus_yevick;
    if (packing == "independent") composition.packing = Packing::independent;

    composition.volume_solids = reader.optional_number("volume_solids");

    composition.pigments = read_pigments(reader, context);
    return composition;
}

// A file beside the recipe. Names that no file can have (too long, say) belong to files that are not there.
fs::path file_named(const TableReader& reader, const char* key, const std::string& name, const Context& context) {
    const fs::path file = context.folder / name;
    std::error_code ignored;
    if (!fs::exists(file, ignored))
        throw input_error(reader.where(key), fmt::format("{}: file not found", file.string()));
    return file;
}

OpticalLayer read_optical_layer(const TableReader& reader, bool is_lowest, const Context& context) {
    static constexpr std::string_view composition_keys[] = {"thickness_um", "binder",  "binder_density_g_cm3",
                                                            "pigments",     "packing", "volume_solids"};
    static constexpr std::string_view expansion_key[] = {"expansion"};
    reader.forbid(composition_keys, "the layer is given in optical terms (it has optical_thickness)");

    OpticalLayer layer{reader.number("optical_thickness"),
                       reader.number("single_scattering_albedo"),
                       {},
                       reader.optional_number("refractive_index").value_or(1.0)};
    if (std::isinf(layer.optical_thickness) && !is_lowest)
        throw input_error(reader.where("optical_thickness"), "an infinite layer hides what lies below it",
                          "only the lowest layer may be infinite");
    const bool by_matrix = reader.has("matrix");
    if (by_matrix) reader.forbid(expansion_key, "matrix says how the layer scatters");
    const char* key = by_matrix ? "matrix" : "expansion";
    const fs::path file = file_named(reader, key, reader.text(key), context);
    layer.expansion = only_law(by_matrix ? read_matrix_csv(file) : read_expansion_csv(file), file);
    return layer;
}

RecipeLayer read_layer(const toml::table& table, const std::string& path, bool is_lowest, const Context& context) {
    const TableReader reader(table, recipe_keys("[[layers]]"), path, context.file);
    const std::string name = reader.optional_text("name").value_or("");
    if (reader.has("optical_thickness")) return {name, read_optical_layer(reader, is_lowest, context)};
    return {name, read_composition(reader, context)};
}

spectral::Spectrum read_reflectance(const TableReader& reader, const Context& context) {
    const toml::node* node = reader.node("reflectance");
    if (!node || !node->is_string()) return spectral::Spectrum(reader.number("reflectance"));
    const fs::path file = file_named(reader, "reflectance", *node->value<std::string>(), context);
    spectral::Spectrum spectrum = spectral::read_spectrum(file, spectral::Outside::hold);
    for (const double value : spectrum.values())
        if (!(value >= 0.0 && value <= 1.0))
            throw input_error({file.string()}, fmt::format("a reflectance of {:g}", value),
                              "reflectances lie between 0 and 1");
    return spectrum;
}

// The facets of a table with the keys alpha and distribution; alpha must be present.
rt::RoughSurface read_roughness(const TableReader& reader) {
    const double alpha = reader.number("alpha");
    const bool ggx = reader.choice("distribution", {"ggx", "beckmann"}) == "ggx";
    return {alpha, ggx ? rt::FacetDistribution::ggx : rt::FacetDistribution::beckmann};
}

// Appends the layers of another recipe, and takes its base.
void append_recipe(const TableReader& reader, const Context& context, Recipe& recipe) {
    const fs::path file = file_named(reader, "recipe", reader.text("recipe"), context);
    if (context.depth >= most_nested_recipes)
        throw input_error(reader.where("recipe"), fmt::format("{} recipes lie on each other", most_nested_recipes + 1),
                          "does one lie on itself?");
    const Recipe below = read_recipe_at(file, context.depth + 1);
    for (const RecipeLayer& layer : recipe.layers)
        if (const auto* optical = std::get_if<OpticalLayer>(&layer.content);
            optical && std::isinf(optical->optical_thickness))
            throw input_error(reader.where("recipe"), "an infinite layer hides what lies below it", "",
                              "leave the base out");
    recipe.layers.insert(recipe.layers.end(), below.layers.begin(), below.layers.end());
    recipe.base = below.base;
    if (recipe.layers.size() > most_layers)
        throw input_error(reader.where("recipe"), fmt::format("{} layers", recipe.layers.size()),
                          fmt::format("at most {} make sense", most_layers));

    // Keep what was read, for provenance.
    std::istringstream lines(below.text);
    recipe.text += fmt::format("\n# base.recipe, {}:\n", file.filename().string());
    for (std::string line; std::getline(lines, line);) recipe.text += "# " + line + "\n";
}

TableBase read_table_base(const TableReader& reader, const Context& context, const Recipe& recipe) {
    const fs::path file = file_named(reader, "file", reader.text("file"), context);
    if (const auto* optical = std::get_if<OpticalLayer>(&recipe.layers.back().content);
        optical && std::isinf(optical->optical_thickness))
        throw input_error(reader.where("file"), "an infinite layer hides what lies below it", "", "leave the base out");
    TableBase base{file, read_base_table(file), reader.optional_number("refractive_index")};
    if (!base.medium_index(base.table->wavelengths_nm.front()))
        throw input_error(reader.where("file"),
                          fmt::format("{} does not record the refractive index its directions are in", file.string()),
                          "a surface in air and one below a clear coat reflect differently",
                          "refractive_index = 1 for one measured in air");
    return base;
}

void read_base(const toml::table* table, const Context& context, Recipe& recipe) {
    if (!table) return;
    const TableReader reader(*table, recipe_keys("[base]"), "base", context.file);
    static constexpr std::string_view metal_keys[] = {"material", "alpha", "distribution"},
                                      reflectance_key[] = {"reflectance"}, recipe_key[] = {"recipe"},
                                      table_keys[] = {"file", "refractive_index"};
    static constexpr std::string_view distribution_key[] = {"distribution"};
    const std::string type = reader.choice("type", {"none", "lambertian", "metal", "recipe", "table"});
    if (type != "table") reader.forbid(table_keys, "only a base of type \"table\" has one");
    if (type != "metal") reader.forbid(metal_keys, "only a metal base has a material and facets");
    if (type != "lambertian") reader.forbid(reflectance_key, "only a lambertian base has a reflectance");
    if (type != "recipe") reader.forbid(recipe_key, "only a base of type \"recipe\" has one");
    if (type == "metal") {
        if (!reader.has("alpha")) reader.forbid(distribution_key, "a metal base without alpha is a mirror");
        MetalBase metal{read_material(reader, "material", context), {}};
        if (reader.has("alpha")) metal.roughness = read_roughness(reader);
        recipe.base = std::move(metal);
    }
    if (type == "lambertian") recipe.base = LambertianBase{read_reflectance(reader, context)};
    if (type == "table") recipe.base = read_table_base(reader, context, recipe);
    if (type == "recipe") append_recipe(reader, context, recipe);
}

void read_interface(const toml::table* table, const Context& context, Recipe& recipe) {
    if (!table) return;
    const TableReader reader(*table, recipe_keys("[interface]"), "interface", context.file);
    recipe.has_interface = true;
    static constexpr std::string_view rough_keys[] = {"alpha", "distribution"};
    if (reader.choice("type", {"smooth", "rough"}) == "rough")
        recipe.interface_roughness = read_roughness(reader);
    else
        reader.forbid(rough_keys, "only an interface of type \"rough\" has facets");
}

toml::table parse_toml(const std::string& text, const std::string& name) {
    try {
        return toml::parse(text, name);
    } catch (const toml::parse_error& error) {
        const toml::source_position at = error.source().begin;
        throw input_error({name, static_cast<int>(at.line), static_cast<int>(at.column)}, "not TOML",
                          error.description());
    }
}

// One step of "layers.0.thickness_um": a key of a table or an index of an array.
toml::node* step_into(toml::node& node, const std::string& step) {
    if (toml::table* table = node.as_table()) return table->get(step);
    toml::array* array = node.as_array();
    const bool is_index = !step.empty() && step.size() < 6 && step.find_first_not_of("0123456789") == std::string::npos;
    return array && is_index ? array->get(std::stoul(step)) : nullptr;
}

// A word of the command line that cannot be used.
Error bad_setting(const std::string& setting, const std::string& why) {
    constexpr std::size_t shown = 200;
    return Error(ErrorKind::usage, fmt::format("--set {}{}: {}", setting.substr(0, shown),
                                               setting.size() > shown ? "..." : "", why.substr(0, shown)));
}

// Makes the assignment "path.to.key=value" in the tree; the value is TOML, or a string when it is not.
void assign(toml::table& root, const std::string& setting) {
    const size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
        throw bad_setting(setting, "write key=value, as in layers.0.thickness_um=30");
    std::vector<std::string> steps;
    std::istringstream path(setting.substr(0, equals));
    for (std::string step; std::getline(path, step, '.');) steps.push_back(step);

    toml::node* node = &root;
    for (size_t i = 0; i + 1 < steps.size(); ++i) {
        node = step_into(*node, steps[i]);
        if (!node) throw bad_setting(setting, fmt::format("the recipe has no \"{}\"", steps[i]));
    }
    toml::table* parent = node->as_table();
    if (!parent) throw bad_setting(setting, fmt::format("\"{}\" is not a key of a table", steps.back()));

    // A pigment has one concentration: a new one takes the place of the old.
    if (const auto begin = std::begin(concentration_keys), end = std::end(concentration_keys);
        std::find(begin, end, steps.back()) != end)
        for (const std::string_view key : concentration_keys) parent->erase(key);

    const std::string value = setting.substr(equals + 1);
    const auto insert = [&](const std::string& toml_value) {
        toml::table parsed = toml::parse("value = " + toml_value, std::string("--set"));
        parsed.get("value")->visit([&](auto&& concrete) { parent->insert_or_assign(steps.back(), concrete); });
    };
    try {
        insert(value);
    } catch (const toml::parse_error&) {
        parent->insert_or_assign(steps.back(), value);
    }
}

Recipe parse(const std::string& text, const Context& context, const std::vector<std::string>& settings) {
    const std::string& name = context.file;
    toml::table root = parse_toml(text, name);
    for (const std::string& setting : settings) assign(root, setting);

    const TableReader reader(root, recipe_keys(""), "", name);
    Recipe recipe;
    recipe.path = name;
    recipe.title = reader.optional_text("title").value_or("");
    recipe.extrapolation = reader.choice("extrapolation", {"refuse", "hold"}) == "hold" ? optics::Extrapolation::hold
                                                                                        : optics::Extrapolation::refuse;
    read_interface(reader.table("interface"), context, recipe);

    const std::vector<const toml::table*> layers = reader.tables("layers");
    if (layers.empty())
        throw input_error(SourceLocation{name}, "a recipe needs at least one [[layers]]", "",
                          "patina new paint NAME writes a commented starter");
    if (layers.size() > most_layers)
        throw input_error(reader.where("layers"), fmt::format("{} layers", layers.size()),
                          fmt::format("at most {} make sense", most_layers));
    for (size_t i = 0; i < layers.size(); ++i)
        recipe.layers.push_back(read_layer(*layers[i], fmt::format("layers.{}", i), i + 1 == layers.size(), context));
    if (const std::optional<double> volume_solids = reader.optional_number("volume_solids"))
        for (RecipeLayer& layer : recipe.layers)
            if (Composition* composition = std::get_if<Composition>(&layer.content);
                composition && !composition->volume_solids)
                composition->volume_solids = volume_solids;

    std::ostringstream written;
    written << root;
    recipe.text = settings.empty() ? text : written.str();
    read_base(reader.table("base"), context, recipe);
    return recipe;
}

Recipe read_recipe_at(const fs::path& path, int depth) {
    return parse(read_text_file(path, largest_recipe), {path.string(), path.parent_path(), depth}, {});
}

}  // namespace

Recipe parse_recipe(const std::string& text, const std::string& name, const fs::path& folder,
                    const std::vector<std::string>& settings) {
    return parse(text, {name, folder}, settings);
}

Recipe read_recipe(const fs::path& path, const std::vector<std::string>& settings) {
    return parse_recipe(read_text_file(path, largest_recipe), path.string(), path.parent_path(), settings);
}

bool Recipe::is_wavelength_independent() const {
    const bool optical = std::all_of(layers.begin(), layers.end(), [](const RecipeLayer& layer) {
        return std::holds_alternative<OpticalLayer>(layer.content);
    });
    if (!optical || std::holds_alternative<MetalBase>(base)) return false;
    if (const auto* known = std::get_if<TableBase>(&base)) return known->table->wavelengths_nm.size() == 1;
    const LambertianBase* lambertian = std::get_if<LambertianBase>(&base);
    return !lambertian || lambertian->reflectance.is_uniform();
}

}  // namespace patina::coating
