#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/jobs/scattering.h"

namespace patina::cli {

namespace {

struct Options {
    std::string recipe, wavelengths, expansion_file, matrix_file, angles = "0:180:1";
    std::vector<std::string> settings;
    int layer = 0;
    double tolerance = 1e-6;
};

nlohmann::json to_json(const jobs::LayerScattering& layer) {
    nlohmann::json pigments = nlohmann::json::array();
    for (const jobs::ParticleScattering& pigment : layer.pigments) {
        const optics::ScatteringProperties& p = pigment.particles.properties;
        pigments.push_back({{"name", pigment.name},
                            {"volume_fraction", pigment.volume_fraction},
                            {"number_density_per_um3", pigment.particles.number_density_per_um3},
                            {"extinction_um2", p.extinction_um2},
                            {"scattering_um2", p.scattering_um2},
                            {"absorption_um2", p.absorption_um2},
                            {"asymmetry", p.asymmetry()},
                            {"mean_volume_um3", p.mean_volume_um3},
                            {"effective_radius_um", p.effective_radius_um}});
    }
    const auto optional = [](std::optional<double> x) { return x ? nlohmann::json(*x) : nlohmann::json(nullptr); };
    const bool finite = std::isfinite(layer.optical_thickness);
    const optics::ExpansionCoefficients& c = layer.expansion;
    return {{"layer", layer.layer},
            {"wavelength_nm", optional(layer.wavelength_nm)},
            {"name", layer.name},
            {"thickness_um", optional(layer.thickness_um)},
            {"refractive_index", layer.refractive_index},
            {"optical_thickness", finite ? nlohmann::json(layer.optical_thickness) : nlohmann::json("inf")},
            {"extinction_per_um", optional(layer.extinction_per_um())},
            {"single_scattering_albedo", layer.albedo},
            {"asymmetry", layer.asymmetry()},
            {"expansion",
             {{"alpha1", c.alpha1},
              {"alpha2", c.alpha2},
              {"alpha3", c.alpha3},
              {"alpha4", c.alpha4},
              {"beta1", c.beta1},
              {"beta2", c.beta2}}},
            {"pigments", pigments}};
}

void show(const jobs::LayerScattering& layer, Console& console) {
    console.result(fmt::format("layer {}: {}{}{}", layer.layer, layer.name,
                               layer.thickness_um ? fmt::format(", {:g} um", *layer.thickness_um) : "",
                               layer.wavelength_nm ? fmt::format(", at {:g} nm", *layer.wavelength_nm) : ""));
    console.result(fmt::format(
        "  n {:.5f}, optical thickness {:.6g}, single scattering albedo {:.8g}, asymmetry "
        "{:.6f}, {} orders",
        layer.refractive_index, layer.optical_thickness, layer.albedo, layer.asymmetry(), layer.expansion.order() + 1));
    if (const std::optional<double> extinction = layer.extinction_per_um()) {
        const double scattering = *extinction * layer.albedo;
        console.result(fmt::format(
            "  per um: extinction {:.6g}, scattering {:.6g}, scattering (1 - g) {:.6g}, "
            "absorption {:.6g}",
            *extinction, scattering, scattering * (1 - layer.asymmetry()), *extinction * (1 - layer.albedo)));
    }
    if (layer.pigments.empty()) return;
    console.result(fmt::format("  {:<24}{:>12}{:>14}{:>14}{:>14}{:>10}{:>10}", "of a particle", "per um^3",
                               "C_ext um^2", "C_sca um^2", "C_abs um^2", "g", "r_eff um"));
    for (const jobs::ParticleScattering& pigment : layer.pigments) {
        const optics::ScatteringProperties& p = pigment.particles.properties;
        console.result(fmt::format("  {:<24}{:>12.5g}{:>14.6g}{:>14.6g}{:>14.6g}{:>10.5f}{:>10.5g}", pigment.name,
                                   pigment.particles.number_density_per_um3, p.extinction_um2, p.scattering_um2,
                                   p.absorption_um2, p.asymmetry(), p.effective_radius_um));
    }
}

// What the files hold: one layer, at all wavelengths.
std::vector<jobs::LayerScattering> chosen_layer(const jobs::ScatteringResult& result, int layer) {
    std::vector<jobs::LayerScattering> chosen;
    for (const jobs::LayerScattering& one : result.layers)
        if (one.layer == layer) chosen.push_back(one);
    if (chosen.empty())
        throw Error(ErrorKind::usage,
                    fmt::format("--layer {}: the recipe has layers 0 to {}", layer, result.layers.back().layer));
    return chosen;
}

int run(const Options& options, Session& session) {
    const coating::Recipe recipe = coating::read_recipe(options.recipe, options.settings);
    std::vector<double> wavelengths;
    if (!options.wavelengths.empty()) wavelengths = parse_number_list(options.wavelengths, "--wavelength-nm");
    for (const double angle : parse_number_list(options.angles, "--angles"))
        if (!(angle >= 0.0 && angle <= 180.0))
            throw Error(ErrorKind::usage, fmt::format("--angles: {:g} is not between 0 and 180 degrees", angle));
    const jobs::ScatteringResult result = jobs::scattering(recipe, wavelengths, options.tolerance);
    const std::vector<jobs::LayerScattering> layer = chosen_layer(result, options.layer);

    Console& console = session.console;
    nlohmann::json layers = nlohmann::json::array();
    for (const jobs::LayerScattering& one : result.layers) {
        show(one, console);
        layers.push_back(to_json(one));
    }
    for (const std::string& note : result.notes) console.note("note: " + note);
    console.document({{"schema", "patina/scattering/1"},
                      {"layers", layers},
                      {"notes", result.notes},
                      {"citations", result.citations}});

    if (!options.expansion_file.empty()) jobs::write_expansion_csv(layer, options.expansion_file);
    if (!options.matrix_file.empty())
        jobs::write_matrix_csv(layer, parse_number_list(options.angles, "--angles"), options.matrix_file);
    return 0;
}

}  // namespace

void add_scattering(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand(
        "scattering", "single scattering of a recipe's layers: cross sections, albedo, expansion coefficients, matrix");
    command->add_option("recipe", options->recipe, "paint recipe (TOML)")->required();
    command->add_option("--wavelength-nm", options->wavelengths, "vacuum wavelengths: 550, or 400,500 or 380:780:10");
    command->add_option("-o,--expansion", options->expansion_file,
                        "write the expansion coefficients (CSV, as recipes read it)");
    command->add_option("--matrix", options->matrix_file, "write the scattering matrix against angle (CSV, likewise)");
    command->add_option("--angles", options->angles, "scattering angles of --matrix, degrees")->capture_default_str();
    command->add_option("--layer", options->layer, "which layer the files hold, 0 on top")->capture_default_str();
    command->add_option("--tolerance", options->tolerance, "of the average over sizes")
        ->check(CLI::Range(1e-12, 0.1))
        ->capture_default_str();
    command->add_option("--set", options->settings, "change a key of the recipe: layers.0.thickness_um=30 (repeatable)")
        ->take_all()
        ->allow_extra_args(false);
    command->footer(
        "example: patina scattering examples/white_wall_paint.toml --wavelength-nm 550 -o coefficients.csv");
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
