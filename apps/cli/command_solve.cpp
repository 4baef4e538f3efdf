#include <algorithm>

#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/io/table_hdf5.h"
#include "patina/jobs/solve.h"

namespace patina::cli {

namespace {

struct Options {
    std::string recipe, output, wavelengths;
    std::vector<std::string> settings;
    int streams = 0;
    double tolerance = 1e-3;
    std::string solver = "doubling";
    bool dry_run = false, resume = false;
};

void print_plan(const Console& console, const jobs::SolvePlan& plan) {
    console.result(fmt::format("wavelengths  {} from {:g} to {:g} nm", plan.wavelengths_nm.size(),
                               plan.wavelengths_nm.front(), plan.wavelengths_nm.back()));
    console.result(
        fmt::format("streams      {} per hemisphere (expansion order {})", plan.streams, plan.largest_expansion_order));
    for (const std::string& note : plan.notes) console.result("note         " + note);
}

nlohmann::json to_json(const jobs::SolvePlan& plan) {
    return {{"wavelengths_nm", plan.wavelengths_nm},
            {"wavelength_error", plan.wavelength_error ? nlohmann::json(*plan.wavelength_error) : nlohmann::json()},
            {"streams", plan.streams},
            {"expansion_order", plan.largest_expansion_order},
            {"notes", plan.notes}};
}

// A band of the visible in steps of the table, for a quick look at colour.
nlohmann::json albedos(const brdf::MuellerTable& table) {
    nlohmann::json rows = nlohmann::json::array();
    for (const double wavelength : table.wavelengths_nm)
        rows.push_back(
            {{"wavelength_nm", wavelength}, {"reflectance_45_deg", table.body_albedo(wavelength, std::sqrt(0.5))}});
    return rows;
}

// A list, or auto for 380 to 780 nm, or auto:FROM:TO.
void choose_wavelengths(const std::string& text, jobs::SolveRequest& request) {
    if (text == "auto") {
        request.automatic_range_nm = {380.0, 780.0};
    } else if (text.starts_with("auto:")) {
        std::string ends = text.substr(5);
        std::replace(ends.begin(), ends.end(), ':', ',');
        const std::vector<double> values = parse_number_list(ends, "--wavelengths");
        if (values.size() != 2)
            throw Error(ErrorKind::usage, fmt::format("--wavelengths {}: write auto or auto:380:780", text));
        request.automatic_range_nm = {values[0], values[1]};
    } else if (!text.empty()) {
        request.wavelengths_nm = parse_number_list(text, "--wavelengths");
    }
}

int run(const Options& options, Session& session) {
    const coating::Recipe recipe = coating::read_recipe(options.recipe, options.settings);
    jobs::SolveRequest request;
    choose_wavelengths(options.wavelengths, request);
    request.streams = options.streams;
    request.tolerance = options.tolerance;
    request.solver = options.solver;
    request.command = session.command_line;
    Console& console = session.console;

    if (options.dry_run) {
        const jobs::SolvePlan plan = jobs::plan_solve(recipe, request);
        print_plan(console, plan);
        console.document({{"schema", "patina/solve/1"}, {"plan", to_json(plan)}});
        return 0;
    }
    if (options.output.empty()) throw Error(ErrorKind::usage, "patina solve needs -o OUT.h5 (or --dry-run)");
    expect_writable(options.output);
    request.checkpoint = options.output + ".checkpoint";
    request.resume = options.resume;
    std::error_code ignored;
    if (options.resume && !std::filesystem::exists(request.checkpoint, ignored))
        console.note(fmt::format("note: no {}: nothing to resume, all is solved", request.checkpoint.string()));

    const jobs::SolveResult result = jobs::solve(recipe, request, session.control());
    io::write_table_hdf5(result.table, options.output);
    if (!result.interrupted) std::filesystem::remove(request.checkpoint);
    console.end_progress();
    for (const std::string& note : result.plan.notes) console.note("note: " + note);
    console.result(fmt::format(
        "{}: {} wavelengths, {} x {} directions, body reflectance at 45 deg {:.4f} ({:g} nm)", options.output,
        result.table.wavelengths_nm.size(), result.table.mu.size(), result.table.mu.size(),
        result.table.body_albedo(result.table.wavelengths_nm[result.table.wavelengths_nm.size() / 2], std::sqrt(0.5)),
        result.table.wavelengths_nm[result.table.wavelengths_nm.size() / 2]));
    if (!result.table.error_estimate.empty())
        console.result(
            fmt::format("error of the body BRDF up to 85 deg at most {:.1e} of its largest value, {} streams",
                        result.relative_error, result.plan.streams));
    console.document({{"schema", "patina/solve/1"},
                      {"output", options.output},
                      {"error_estimate", result.table.error_estimate},
                      {"relative_error", result.relative_error},
                      {"plan", to_json(result.plan)},
                      {"interrupted", result.interrupted},
                      {"resumed", result.resumed},
                      {"converged", result.converged},
                      {"body", albedos(result.table)}});
    if (result.interrupted) {
        console.note(
            "stopped early: the table holds the wavelengths that were done; the same command with --resume solves the "
            "rest");
        return static_cast<int>(ErrorKind::interrupted);
    }
    console.hint(fmt::format("patina plot {} -o lobe.svg --kind lobe", options.output));
    return result.converged ? 0 : static_cast<int>(ErrorKind::check);
}

}  // namespace

void add_solve(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        program.add_subcommand("solve", "compute the 4x4 Mueller BRDF of a recipe, wavelength by wavelength");
    command->add_option("recipe", options->recipe, "paint recipe (TOML)")->required();
    command->add_option("-o,--output", options->output, "BRDF table to write (HDF5)");
    command->add_option("--wavelengths", options->wavelengths,
                        "vacuum wavelengths in nm: 380:780:5 or 450,550,650; auto or auto:380:780 chooses them");
    command->add_option("--streams", options->streams,
                        "quadrature nodes per hemisphere in air (default: from the tolerance)");
    command->add_option("--tolerance", options->tolerance, "relative accuracy wanted")
        ->check(CLI::Range(1e-8, 0.1))
        ->capture_default_str();
    command->add_option("--solver", options->solver, "doubling | eigenmodes | montecarlo")->capture_default_str();
    command->add_option("--set", options->settings, "change a key of the recipe: layers.0.thickness_um=30 (repeatable)")
        ->take_all()
        ->allow_extra_args(false);
    command->add_flag("--resume", options->resume, "go on where the same command was stopped or killed");
    command->add_flag("--dry-run", options->dry_run, "say what would be done");
    command->footer("example: patina solve examples/tio2_on_aluminium.toml -o tio2.h5 --wavelengths 400:700:10");
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
