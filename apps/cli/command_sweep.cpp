#include "paint_options.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/jobs/sweep.h"

namespace patina::cli {

namespace {

using nlohmann::json;

struct Options : PaintCommandOptions {
    std::string folder;
    std::vector<std::string> vary;
};

jobs::SweepRequest make_request(const Options& options, const Session& session) {
    jobs::SweepRequest request;
    request.recipe = options.recipe;
    request.settings = options.settings;
    for (const std::string& axis : options.vary) request.axes.push_back(jobs::parse_sweep_axis(axis));
    request.options = to_paint_options(options);
    request.folder = options.folder;
    request.command = session.command_line;
    return request;
}

json to_json(const jobs::SweepRequest& request, const jobs::SweepResult& result) {
    json axes = json::array(), values = json::array();
    for (const jobs::SweepAxis& axis : request.axes) axes.push_back({{"key", axis.key}, {"values", axis.values}});
    for (const std::vector<double>& point : result.values) {
        json row = json::array();
        for (const double value : point) row.push_back(std::isfinite(value) ? json(value) : json(nullptr));
        values.push_back(row);
    }
    return {{"schema", "patina/sweep/1"},
            {"folder", request.folder.string()},
            {"axes", axes},
            {"points", result.points},
            {"computed", result.computed},
            {"reused", result.reused},
            {"interrupted", result.interrupted},
            {"converged", result.converged},
            {"columns", result.columns},
            {"values", values},
            {"notes", result.notes}};
}

int run(const Options& options, Session& session) {
    const jobs::SweepRequest request = make_request(options, session);
    const jobs::SweepResult result = jobs::sweep(request, session.control());
    Console& console = session.console;
    console.end_progress();
    constexpr std::size_t notes_shown = 3;
    for (std::size_t i = 0; i < std::min(notes_shown, result.notes.size()); ++i)
        console.note("note: " + result.notes[i]);
    if (result.notes.size() > notes_shown)
        console.note(
            fmt::format("and {} more notes of single points (--json lists them)", result.notes.size() - notes_shown));
    if (result.foreign > 0)
        console.note(fmt::format(
            "note: {} points in {} belong to another recipe, grid or set of options; they are left alone and not used",
            result.foreign, (request.folder / "points").string()));
    console.document(to_json(request, result));
    if (result.interrupted) {
        console.note(fmt::format("stopped: {} of {} points are done and kept; the same command goes on from there",
                                 result.computed + result.reused, result.points));
        return static_cast<int>(ErrorKind::interrupted);
    }
    console.result(fmt::format("{}: {} points ({} computed, {} found done)", (request.folder / "sweep.h5").string(),
                               result.points, result.computed, result.reused));
    console.result(fmt::format("{}: {} columns", (request.folder / "sweep.csv").string(),
                               request.axes.size() + result.columns.size()));
    return result.converged ? 0 : static_cast<int>(ErrorKind::check);
}

}  // namespace

void add_sweep(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand(
        "sweep",
        "paint metrics over a grid of recipe keys, into one HDF5 and one CSV file; goes on where it was stopped");
    add_paint_options(*command, *options);
    command
        ->add_option("--vary", options->vary,
                     "KEY=begin:end:count, with log after the count for even steps of the logarithm (repeatable)")
        ->required()
        ->take_all()
        ->allow_extra_args(false);
    command->add_option("-o,--output", options->folder, "folder for the results")->required();
    command->footer(
        "example: patina sweep examples/white_wall_paint.toml --vary layers.0.pigments.0.volume_fraction=0.02:0.35:12 "
        "-o crowding");
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
