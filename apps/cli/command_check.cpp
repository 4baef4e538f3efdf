#include <filesystem>

#include "command.h"
#include <fmt/format.h>

#include "patina/brdf/physical_checks.h"
#include "patina/core/error.h"
#include "patina/io/table_hdf5.h"
#include "patina/jobs/check.h"

namespace patina::cli {

namespace {

nlohmann::json number_or_null(double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

nlohmann::json to_json(const brdf::PhysicalCheck& check) {
    return {{"name", check.name},
            {"explanation", check.explanation},
            {"passed", check.passed},
            {"worst", check.worst},
            {"tolerance", check.tolerance},
            {"wavelength_nm", number_or_null(check.wavelength_nm)},
            {"theta_o_deg", number_or_null(check.theta_o_deg)},
            {"theta_i_deg", number_or_null(check.theta_i_deg)},
            {"phi_deg", number_or_null(check.phi_deg)}};
}

struct Options {
    std::string file, model, properties;
};

int run_models(const std::vector<render::BsdfReport>& reports, const std::string& name, Session& session) {
    nlohmann::json models = nlohmann::json::array();
    bool passed = true;
    for (const render::BsdfReport& report : reports) {
        passed = passed && report.passed();
        const std::string id = report.id.empty() ? std::string() : fmt::format(" \"{}\"", report.id);
        session.console.result(fmt::format("{}{} ({})", report.type, id, report.where.to_string()));
        nlohmann::json rows = nlohmann::json::array();
        for (const render::BsdfCheck& check : report.checks) {
            session.console.result(fmt::format("  {:<6} {:<13} worst {:9.2e} (allowed {:.0e})  {}",
                                               check.passed() ? "ok" : "FAILED", check.name, check.worst,
                                               check.tolerance, check.explanation));
            rows.push_back({{"name", check.name},
                            {"explanation", check.explanation},
                            {"passed", check.passed()},
                            {"worst", number_or_null(check.worst)},
                            {"tolerance", check.tolerance},
                            {"wavelength_nm", check.wavelength_nm},
                            {"theta_o_deg", check.theta_o_deg}});
        }
        models.push_back({{"type", report.type},
                          {"id", report.id},
                          {"line", report.where.line},
                          {"column", report.where.column},
                          {"passed", report.passed()},
                          {"checks", rows}});
    }
    session.console.document(
        {{"schema", "patina/check-models/1"}, {"file", name}, {"passed", passed}, {"models", models}});
    return passed ? 0 : static_cast<int>(ErrorKind::check);
}

int run_table(const std::string& file, Session& session) {
    const brdf::MuellerTable table = io::read_table_hdf5(file);
    const std::vector<brdf::PhysicalCheck> checks = brdf::check_physics(table);

    nlohmann::json rows = nlohmann::json::array();
    bool passed = true;
    for (const brdf::PhysicalCheck& check : checks) {
        passed = passed && check.passed;
        rows.push_back(to_json(check));
        session.console.result(fmt::format("{:<6} {:<16} worst {:9.2e} (allowed {:.0e})  {}",
                                           check.passed ? "ok" : "FAILED", check.name, check.worst, check.tolerance,
                                           check.explanation));
    }
    session.console.document({{"schema", "patina/check/1"}, {"file", file}, {"passed", passed}, {"checks", rows}});
    return passed ? 0 : static_cast<int>(ErrorKind::check);
}

int run(const Options& options, Session& session) {
    if (options.file.empty() == options.model.empty())
        throw Error(ErrorKind::usage, "check takes a table (.h5), a scene (.xml) or --bsdf NAME");
    if (!options.model.empty())
        return run_models(jobs::check_model(options.model, options.properties, session.control()), "", session);
    if (!options.properties.empty()) throw Error(ErrorKind::usage, "--properties goes with --bsdf");
    if (std::filesystem::path(options.file).extension() == ".xml")
        return run_models(jobs::check_scene(options.file, session.control()), options.file, session);
    return run_table(options.file, session);
}

}  // namespace

void add_check(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand(
        "check",
        "try a BRDF table or reflection models against the laws every reflection obeys (exit code 4 when one fails)");
    command->add_option("file", options->file, "BRDF table (.h5), or a scene (.xml): all its reflection models");
    command->add_option("--bsdf", options->model, "a reflection model by its name, with its defaults");
    command->add_option("--properties", options->properties,
                        "of the model, as in a scene: '<float name=\"alpha\" value=\"0.3\"/>'");
    command->footer("examples: patina check paint.h5, patina check scene.xml, patina check --bsdf roughconductor");
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
