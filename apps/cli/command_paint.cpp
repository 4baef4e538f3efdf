#include "paint_options.h"
#include <fmt/format.h>

#include "patina/coating/paint_metrics_colour.h"
#include "patina/core/error.h"
#include "patina/io/table_hdf5.h"
#include "patina/jobs/paint.h"

namespace patina::cli {

namespace {

using coating::PaintMetrics;
using coating::ReflectanceSpectra;
using nlohmann::json;

struct Options : PaintCommandOptions {
    std::string target, against;
    bool quick = false;
};

// What is seen over what, by name.
struct Background {
    const char* name;
    const char* text;
    const ReflectanceSpectra* spectra;
};

std::vector<Background> backgrounds(const PaintMetrics& m) {
    return {{"own_base", "own base", &m.own},
            {"black", "black", &m.over_black},
            {"white", "white card", &m.over_white},
            {"infinite", "infinite", &m.infinite}};
}

struct GeometryOf {
    const char* name;
    const std::vector<double>& (*values)(const ReflectanceSpectra&);
};

const GeometryOf geometries[] = {
    {"45:0", [](const ReflectanceSpectra& r) -> const std::vector<double>& { return r.r45_0; }},
    {"d:8 excluded", [](const ReflectanceSpectra& r) -> const std::vector<double>& { return r.d8_excluded; }},
    {"d:8 included", [](const ReflectanceSpectra& r) -> const std::vector<double>& { return r.d8_included; }},
};

json finite(double value) {
    return std::isfinite(value) ? json(value) : json(nullptr);
}
json lab_json(const Eigen::Vector3d& lab) {
    return {lab[0], lab[1], lab[2]};
}

double luminous(const PaintMetrics& m, const std::vector<double>& reflectance) {
    return coating::tristimulus(m.wavelengths_nm, reflectance, coating::laboratory_viewing)[1];
}

json reflectance_json(const PaintMetrics& m) {
    json result = json::object();
    for (const Background& background : backgrounds(m)) {
        json& entry = result[background.name];
        for (const GeometryOf& geometry : geometries) {
            entry["luminous"][geometry.name] = luminous(m, geometry.values(*background.spectra));
            entry["spectra"][geometry.name] = geometry.values(*background.spectra);
        }
        entry["spectra"]["d:d excluded"] = background.spectra->bihemispherical;
    }
    return result;
}

json colours_json(const PaintMetrics& m) {
    json rows = json::array();
    for (const Background& background : backgrounds(m))
        for (const GeometryOf& geometry : geometries)
            for (const coating::Viewing& viewing : coating::usual_viewings())
                rows.push_back(
                    {{"over", background.name},
                     {"geometry", geometry.name},
                     {"illuminant", viewing.illuminant},
                     {"observer_deg", coating::observer_deg(viewing.observer)},
                     {"lab", lab_json(coating::lab(m.wavelengths_nm, geometry.values(*background.spectra), viewing))}});
    return rows;
}

json film_json(const PaintMetrics& m) {
    json rows = json::array();
    const std::string unit = m.thickness_is_optical ? "per_optical_thickness" : "per_um";
    for (std::size_t w = 0; w < m.film.size(); ++w) {
        const coating::FilmCoefficients& film = m.film[w];
        rows.push_back({{"wavelength_nm", m.wavelengths_nm[w]},
                        {"kubelka_munk_k_" + unit, film.kubelka_munk ? json(film.kubelka_munk->k) : json(nullptr)},
                        {"kubelka_munk_s_" + unit, film.kubelka_munk ? json(film.kubelka_munk->s) : json(nullptr)},
                        {m.thickness_is_optical ? "kubelka_munk_optical_thickness" : "kubelka_munk_thickness_um",
                         film.kubelka_munk_thickness},
                        {"saunderson_k1", film.surface.k1},
                        {"saunderson_k2", film.surface.k2},
                        {"transport_scattering_" + unit, film.transport_scattering},
                        {"absorption_" + unit, film.absorption}});
    }
    return rows;
}

json to_json(const Options& options, const coating::Recipe& recipe, const jobs::PaintReport& report) {
    const PaintMetrics& m = report.metrics;
    const coating::HidingPower& hiding = m.hiding;
    const coating::WhitenessAndYellowness white = coating::whiteness(m.wavelengths_nm, m.own.r45_0);
    json aspecular = json::array(), gloss = json::array();
    for (const jobs::AspecularColour& colour : report.aspecular)
        aspecular.push_back({{"aspecular_deg", colour.aspecular_deg},
                             {"reflectance_factor", colour.reflectance},
                             {"lab", lab_json(colour.lab)}});
    for (const jobs::Gloss& value : report.gloss)
        gloss.push_back({{"theta_deg", value.theta_deg}, {"gloss_units", value.gloss_units}});

    json document = {{"schema", "patina/paint/1"},
                     {"recipe", options.recipe},
                     {"title", recipe.title},
                     {"wavelengths_nm", m.wavelengths_nm},
                     {"contrast_ratio", finite(m.contrast.r45_0)},
                     {"contrast_ratio_geometry", "45:0, Y of D65 and 10 degrees"},
                     {"contrast_ratios",
                      {{"45:0", finite(m.contrast.r45_0)},
                       {"d:8 excluded", finite(m.contrast.d8_excluded)},
                       {"d:8 included", finite(m.contrast.d8_included)}}},
                     {"white_card_reflectance", m.white_reflectance},
                     {"hiding_contrast_ratio", m.wanted_contrast_ratio},
                     {"hiding_power_m2_per_l",
                      hiding.spreading_rate_m2_per_l ? json(*hiding.spreading_rate_m2_per_l) : json(nullptr)},
                     {"hiding_power_why_not", hiding.why_not},
                     {m.thickness_is_optical ? "hiding_optical_thickness" : "hiding_thickness_um",
                      hiding.thickness ? json(*hiding.thickness) : json(nullptr)},
                     {"volume_solids", hiding.volume_solids},
                     {"volume_solids_given", hiding.volume_solids_given},
                     {"layer", m.layer},
                     {m.thickness_is_optical ? "optical_thickness" : "thickness_um", finite(m.thickness)},
                     {"reflectance", reflectance_json(m)},
                     {"colours", colours_json(m)},
                     {"film", film_json(m)},
                     {"whiteness",
                      {{"standard", "ASTM E313"},
                       {"geometry", "45:0, D65, 10 degrees, own base"},
                       {"whiteness", finite(white.whiteness)},
                       {"tint", finite(white.tint)},
                       {"yellowness", finite(white.yellowness)},
                       {"whiteness_valid", white.whiteness_valid}}},
                     {"aspecular", aspecular},
                     {"gloss", gloss},
                     {"streams", m.streams},
                     {"converged", m.converged},
                     {"notes", m.notes}};
    if (report.tinting_strength) {
        const coating::TintingStrength& strength = *report.tinting_strength;
        document["tinting_strength"] = {{"against", options.against},
                                        {"geometry", "films without end, d:8 excluded, Saunderson"},
                                        {"wavelength_nm", strength.wavelength_nm},
                                        {"at_maximum", strength.at_maximum},
                                        {"integrated", strength.integrated},
                                        {"delta_e_2000", strength.delta_e_2000},
                                        {"k_over_s", strength.k_over_s},
                                        {"k_over_s_standard", strength.k_over_s_standard}};
    }
    if (report.target_lab)
        document["target"] = {{"lab", lab_json(*report.target_lab)},
                              {"delta_e_2000", *report.delta_e_2000},
                              {"geometry", "45:0, D65, 10 degrees, own base"}};
    return document;
}

void print_hiding(const Console& console, const PaintMetrics& m) {
    const coating::HidingPower& hiding = m.hiding;
    const char* unit = m.thickness_is_optical ? "optical thickness" : "um dry";
    console.result(
        fmt::format("contrast ratio      {:.4f}  (45:0)   {:.4f}  (d:8, specular excluded)   {:.4f}  (d:8, included)",
                    m.contrast.r45_0, m.contrast.d8_excluded, m.contrast.d8_included));
    console.result(
        fmt::format("                    of layer {} at {:g} {}; Y of D65, 10 deg, over black and over white of {:g} "
                    "in optical contact",
                    m.layer, m.thickness, unit, m.white_reflectance));
    if (!hiding.thickness) {
        console.result(fmt::format("hiding power        none: {}", hiding.why_not));
        return;
    }
    if (hiding.spreading_rate_m2_per_l)
        console.result(fmt::format("hiding power        {:.2f} m2/l at contrast ratio {:g} (45:0): {:.2f} um dry, {}",
                                   *hiding.spreading_rate_m2_per_l, m.wanted_contrast_ratio, *hiding.thickness,
                                   hiding.volume_solids_given
                                       ? fmt::format("volume solids {:g}", hiding.volume_solids)
                                       : "a litre of DRY paint (the recipe has no volume_solids)"));
    else
        console.result(fmt::format("hiding power        contrast ratio {:g} (45:0) at optical thickness {:.4f}",
                                   m.wanted_contrast_ratio, *hiding.thickness));
}

void print_reflectance(const Console& console, const PaintMetrics& m) {
    console.result("");
    console.result("Y, D65, 10 deg        45:0   d:8 excl   d:8 incl");
    for (const Background& background : backgrounds(m)) {
        std::string line = fmt::format("  {:<14}", background.text);
        for (const GeometryOf& geometry : geometries)
            line += fmt::format(" {:10.4f}", luminous(m, geometry.values(*background.spectra)));
        console.result(line);
    }
}

void print_colour(const Console& console, const jobs::PaintReport& report) {
    const PaintMetrics& m = report.metrics;
    console.result("");
    console.result("own base                     45:0                          d:8 included");
    console.result("                       L*      a*      b*             L*      a*      b*");
    for (const coating::Viewing& viewing : coating::usual_viewings()) {
        const Eigen::Vector3d a = coating::lab(m.wavelengths_nm, m.own.r45_0, viewing),
                              b = coating::lab(m.wavelengths_nm, m.own.d8_included, viewing);
        console.result(fmt::format("  {:<4} {:>2} deg      {:7.2f} {:7.2f} {:7.2f}        {:7.2f} {:7.2f} {:7.2f}",
                                   viewing.illuminant, coating::observer_deg(viewing.observer), a[0], a[1], a[2], b[0],
                                   b[1], b[2]));
    }
    for (const jobs::AspecularColour& colour : report.aspecular)
        console.result(fmt::format("  {:<14} {:7.2f} {:7.2f} {:7.2f}", fmt::format("45as{:g}", colour.aspecular_deg),
                                   colour.lab[0], colour.lab[1], colour.lab[2]));
    if (!report.aspecular.empty())
        console.result(
            "  (45as...: light at 45 deg, seen in its plane that far from the mirror direction, ASTM E2194; D65, 10 "
            "deg)");

    const coating::WhitenessAndYellowness white = coating::whiteness(m.wavelengths_nm, m.own.r45_0);
    console.result(fmt::format(
        "  whiteness {:.2f}{}, tint {:.2f}, yellowness {:.2f}  (ASTM E313; 45:0, D65, 10 deg)", white.whiteness,
        white.whiteness_valid ? "" : " (not a white: outside the formula's range)", white.tint, white.yellowness));
    if (!report.gloss.empty())
        console.result(
            fmt::format("  gloss {:.1f} / {:.1f} / {:.1f} at 20 / 60 / 85 deg  (ISO 2813, specular reflection alone)",
                        report.gloss[0].gloss_units, report.gloss[1].gloss_units, report.gloss[2].gloss_units));
    if (report.target_lab)
        console.result(fmt::format("  CIEDE2000 {:.2f} to the target {:.2f}, {:.2f}, {:.2f}  (45:0, D65, 10 deg)",
                                   *report.delta_e_2000, (*report.target_lab)[0], (*report.target_lab)[1],
                                   (*report.target_lab)[2]));
}

void print_tinting_strength(const Console& console, const coating::TintingStrength& strength,
                            const std::string& against) {
    console.result("");
    console.result(fmt::format(
        "tinting strength    {:.1f} % of {} at {:g} nm, where it absorbs most; {:.1f} % over the wavelengths",
        100.0 * strength.at_maximum, against, strength.wavelength_nm, 100.0 * strength.integrated));
    console.result(
        fmt::format("                    K/S of films without end, d:8 excluded, Saunderson (ISO 787-24); CIEDE2000 "
                    "between them {:.2f} "
                    "(D65, 10 deg)",
                    strength.delta_e_2000));
    if (strength.at_maximum > 0.0)
        console.result(
            fmt::format("                    of whites in the same black: relative scattering power {:.1f} %",
                        100.0 / strength.at_maximum));
}

void print_film(const Console& console, const PaintMetrics& m) {
    const char* unit = m.thickness_is_optical ? "per optical thickness" : "per um";
    console.result("");
    console.result(fmt::format(
        "Kubelka-Munk of layer {}, {} (d:8 excluded, Saunderson with k1 {:.4f}, k2 {:.4f}), beside transport theory",
        m.layer, unit, m.film[m.film.size() / 2].surface.k1, m.film[m.film.size() / 2].surface.k2));
    console.result("      nm            K            S   sigma_s(1-g)      sigma_a");
    for (std::size_t w = 0; w<m.film.size(); w += m.film.size()> 11 ? 5 : 1) {
        const coating::FilmCoefficients& film = m.film[w];
        const std::string km = film.kubelka_munk
                                   ? fmt::format("{:12.4e} {:12.4e}", film.kubelka_munk->k, film.kubelka_munk->s)
                                   : fmt::format("{:>12} {:>12}", "-", "-");
        console.result(fmt::format("  {:6.1f} {}   {:12.4e} {:12.4e}", m.wavelengths_nm[w], km,
                                   film.transport_scattering, film.absorption));
    }
}

// L*,a*,b*, or a BRDF table whose 45:0 colour is the target.
Eigen::Vector3d read_target(const std::string& target) {
    if (target.ends_with(".h5")) return jobs::lab_45_0(io::read_table_hdf5(target));
    const std::vector<double> values = parse_number_list(target, "--target");
    if (values.size() != 3)
        throw Error(ErrorKind::usage, fmt::format("--target {}: write L,a,b (three numbers) or a table.h5", target));
    return {values[0], values[1], values[2]};
}

int run(const Options& options, Session& session) {
    const coating::Recipe recipe = coating::read_recipe(options.recipe, options.settings);
    jobs::PaintRequest request;
    request.options = to_paint_options(options);
    request.angular = !options.quick;
    request.command = session.command_line;
    if (!options.against.empty()) request.against = coating::read_recipe(options.against);
    if (!options.target.empty()) request.target_lab = read_target(options.target);

    const jobs::PaintReport report = jobs::paint(recipe, request, session.control());
    Console& console = session.console;
    console.end_progress();
    for (const std::string& note : report.metrics.notes) console.note("note: " + note);
    print_hiding(console, report.metrics);
    print_reflectance(console, report.metrics);
    print_colour(console, report);
    print_film(console, report.metrics);
    if (report.tinting_strength) print_tinting_strength(console, *report.tinting_strength, options.against);
    console.document(to_json(options, recipe, report));
    console.hint(fmt::format("patina sweep {} --vary layers.{}.{}=5:80:12log -o sweep", options.recipe,
                             report.metrics.layer,
                             report.metrics.thickness_is_optical ? "optical_thickness" : "thickness_um"));
    return report.metrics.converged ? 0 : static_cast<int>(ErrorKind::check);
}

}  // namespace

void add_paint(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand(
        "paint", "paint metrics: contrast ratio, hiding power, colour, whiteness, Kubelka-Munk K and S, gloss");
    add_paint_options(*command, *options);
    command->add_option("--target", options->target,
                        "colour to compare with: L,a,b (45:0, D65, 10 deg) or a BRDF table (.h5)");
    command->add_option("--against", options->against,
                        "recipe of a standard: tinting strength, the ratio of K/S (ISO 787-24)");
    command->add_flag("--quick", options->quick, "leave out the colours at several angles and the gloss");
    command->footer("example: patina paint examples/white_wall_paint.toml --set volume_solids=0.4");
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
