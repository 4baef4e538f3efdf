#include "command.h"
#include <fmt/format.h>

#include "patina/brdf/physical_checks.h"
#include "patina/core/error.h"
#include "patina/io/table_hdf5.h"

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

int run(const std::string& file, Session& session) {
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

}  // namespace

void add_check(CLI::App& program, Session& session) {
    auto file = std::make_shared<std::string>();
    CLI::App* command = program.add_subcommand(
        "check", "try a BRDF table against the laws every reflection obeys (exit code 4 when one fails)");
    command->add_option("file", *file, "BRDF table (.h5)")->required();
    command->callback([file, &session] { session.chosen = [file, &session] { return run(*file, session); }; });
}

}  // namespace patina::cli
