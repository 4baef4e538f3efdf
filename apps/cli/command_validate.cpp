#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/jobs/validate.h"

namespace patina::cli {

namespace {

struct Options {
    std::string solver, html, markdown;
};

nlohmann::json to_json(const jobs::ValidatedCase& one) {
    nlohmann::json largest = nlohmann::json::object();
    for (int c = 0; c < 4; ++c)
        if (one.largest[c] >= 0.0) largest[one.components[c]] = one.largest[c];
    const auto text_or_null = [](const std::string& text) {
        return text.empty() ? nlohmann::json(nullptr) : nlohmann::json(text);
    };
    return {
        {"case", one.name},
        {"source", one.source},
        {"quantity", one.quantity},
        {"solver", text_or_null(one.solver)},
        {"skipped", text_or_null(one.skipped)},
        {"values", one.count},
        {"largest_error", largest},
        {"tolerance", one.tolerance},
        {"largest_error_in_tolerances", std::isfinite(one.worst) ? nlohmann::json(one.worst) : nlohmann::json(nullptr)},
        {"passed", one.passed()},
        {"seconds", one.seconds}};
}

nlohmann::json to_json(const jobs::ValidationReport& report) {
    nlohmann::json cases = nlohmann::json::array(), scalar = nlohmann::json::array();
    for (const jobs::ValidatedCase& one : report.cases) cases.push_back(to_json(one));
    for (const jobs::ScalarError& row : report.cost_of_ignoring_polarization)
        scalar.push_back({{"zenith_deg", row.zenith_deg},
                          {"phi_deg", row.phi_deg},
                          {"published", row.published},
                          {"vector", row.vector},
                          {"scalar", row.scalar}});
    return {{"schema", "patina/validate/1"},
            {"software", report.software},
            {"passed", report.passed()},
            {"failures", report.failures()},
            {"cases", cases},
            {"cost_of_ignoring_polarization", scalar}};
}

// Two lines a case: the verdict with the errors, then where the numbers come from.
void print(const Console& console, const jobs::ValidatedCase& one) {
    if (!one.skipped.empty())
        return console.result(fmt::format("--      {:<36} {:<11} left out: {}", one.name, one.solver, one.skipped));
    std::string errors;
    for (int c = 0; c < 4; ++c)
        if (one.largest[c] >= 0.0) errors += fmt::format("  {} {:.1e}", one.components[c], one.largest[c]);
    console.result(fmt::format("{:<7} {:<36} {:<11} {:>5} values {:6.2f} s {}", one.passed() ? "ok" : "FAILED",
                               one.name, one.solver, one.count, one.seconds, errors));
    console.result(fmt::format("        {}; allowed {}", one.source, one.tolerance));
}

void print_scalar(const Console& console, const jobs::ValidationReport& report) {
    console.result("\nWhat ignoring polarization costs (Siewert IIA, intensity at the top, light at 53.1 deg):");
    console.result("  zenith  azimuth  benchmark     vector     scalar   scalar error");
    for (const jobs::ScalarError& row : report.cost_of_ignoring_polarization)
        console.result(fmt::format("{:8.1f} {:8.0f} {:10.6f} {:10.6f} {:10.6f} {:+12.2f} %", row.zenith_deg,
                                   row.phi_deg, row.published, row.vector, row.scalar, row.scalar_percent()));
}

int run(const Options& options, Session& session) {
    for (const std::string& file : {options.html, options.markdown})
        if (!file.empty()) expect_writable(file);
    Console& console = session.console;
    const jobs::ValidationReport report = jobs::validate({options.solver}, session.control());
    console.end_progress();
    for (const jobs::ValidatedCase& one : report.cases) print(console, one);
    print_scalar(console, report);
    console.result(report.passed() ? "\nall benchmarks pass"
                                   : fmt::format("\n{} of {} runs FAILED", report.failures(), report.cases.size()));
    if (!options.html.empty()) write_text_file(options.html, jobs::to_html(report));
    if (!options.markdown.empty()) write_text_file(options.markdown, jobs::to_markdown(report));
    console.document(to_json(report));
    return report.passed() ? 0 : static_cast<int>(ErrorKind::check);
}

}  // namespace

void add_validate(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand(
        "validate",
        "every published benchmark against every solver, with the largest errors (exit code 4 when one fails)");
    command->add_option("--solver", options->solver, "only this solver (default: all)");
    command->add_option("--html", options->html, "also write a page");
    command->add_option("--markdown", options->markdown, "also write the page in Markdown");
    command->footer("example: patina validate --html validation.html");
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
