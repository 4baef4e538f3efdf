#include "command.h"
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/core/error.h"
#include "patina/optics/materials.h"

namespace patina::cli {

namespace {

struct Options {
    std::string name, words;
    double wavelength = 0.0;
};

nlohmann::json to_json(const optics::MaterialInfo& info) {
    return {{"name", info.name},
            {"aliases", info.aliases},
            {"citation", info.citation},
            {"description", info.description},
            {"comments", info.comments},
            {"wavelength_min_nm", info.wavelength_min_nm},
            {"wavelength_max_nm", info.wavelength_max_nm},
            {"k_known", info.k_known}};
}

int list(const std::string& word, Session& session) {
    nlohmann::json rows = nlohmann::json::array();
    session.console.result(fmt::format("{:<18} {:>12}  k    publication", "name", "nm"));
    for (const optics::MaterialInfo& info : optics::search_builtin_materials(word)) {
        rows.push_back(to_json(info));
        session.console.result(fmt::format("{:<18} {:>5.0f} - {:<5.0f} {:<4} {}", info.name, info.wavelength_min_nm,
                                           info.wavelength_max_nm, info.k_known ? "yes" : "no", info.citation));
    }
    session.console.document({{"schema", "patina/materials/1"}, {"materials", rows}});
    if (rows.empty())
        session.console.note(
            fmt::format("no material matches \"{}\"; any refractiveindex.info page or CSV file works too", word));
    return rows.empty() ? static_cast<int>(ErrorKind::runtime) : 0;
}

// The wavelengths of `patina materials show` when none is given.
std::vector<double> sample_wavelengths(const optics::OpticalConstants& material, double wavelength) {
    if (wavelength > 0.0) return {wavelength};
    std::vector<double> wavelengths;
    for (int nm = 380; nm <= 780; nm += 20)
        if (material.covers(nm)) wavelengths.push_back(nm);
    return wavelengths;
}

int show(const Options& options, Session& session) {
    const optics::OpticalConstants material = optics::material(options.name, ".");
    nlohmann::json rows = nlohmann::json::array();
    session.console.result(fmt::format("{}: {}", material.name(), material.citation()));
    session.console.result(fmt::format("measured from {:g} to {:g} nm{}", material.wavelength_min_nm(),
                                       material.wavelength_max_nm(),
                                       material.k_known() ? "" : "; k is not given by the source and taken as 0"));
    session.console.result("      nm          n              k");
    for (const double wavelength : sample_wavelengths(material, options.wavelength)) {
        const std::complex<double> m = material.at(wavelength);
        rows.push_back({{"wavelength_nm", wavelength}, {"n", m.real()}, {"k", m.imag()}});
        session.console.result(fmt::format("{:8.1f} {:10.6f} {:14.6g}", wavelength, m.real(), m.imag()));
    }
    session.console.document({{"schema", "patina/material/1"},
                              {"name", material.name()},
                              {"citation", material.citation()},
                              {"wavelength_min_nm", material.wavelength_min_nm()},
                              {"wavelength_max_nm", material.wavelength_max_nm()},
                              {"k_known", material.k_known()},
                              {"index", rows}});
    return 0;
}

}  // namespace

void add_materials(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand("materials", "optical constants, each with its publication");
    command->require_subcommand(1);

    CLI::App* list_command = command->add_subcommand("list", "the built-in materials");
    list_command->callback([&session] { session.chosen = [&session] { return list("", session); }; });

    CLI::App* search_command = command->add_subcommand("search", "materials by name, alias or author");
    search_command->add_option("word", options->words, "part of a name or publication")->required();
    search_command->callback(
        [options, &session] { session.chosen = [options, &session] { return list(options->words, session); }; });

    CLI::App* show_command = command->add_subcommand("show", "n and k of a built-in material or of a file");
    show_command->add_option("name", options->name, "built-in name, or a refractiveindex.info .yml or CSV file")
        ->required();
    show_command->add_option("--wavelength-nm", options->wavelength, "one vacuum wavelength")
        ->check(CLI::PositiveNumber);
    show_command->callback(
        [options, &session] { session.chosen = [options, &session] { return show(*options, session); }; });
}

}  // namespace patina::cli
