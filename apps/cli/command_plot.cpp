#include "command.h"
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/io/table_hdf5.h"
#include "patina/jobs/plot.h"

namespace patina::cli {

namespace {

struct Options {
    std::vector<std::string> files, labels;
    std::string output, kind = "lobe", title;
    double theta_i = 45.0, wavelength = 550.0;
};

int run(const Options& options, Session& session) {
    expect_writable(options.output);
    if (!options.labels.empty() && options.labels.size() != options.files.size())
        throw Error(ErrorKind::usage,
                    fmt::format("--label: {} labels for {} files", options.labels.size(), options.files.size()));
    jobs::PlotRequest request{jobs::plot_kind_named(options.kind), options.theta_i, options.wavelength, options.title};

    std::vector<brdf::MuellerTable> tables;
    for (const std::string& file : options.files) tables.push_back(io::read_table_hdf5(file));
    std::vector<jobs::PlottedTable> plotted;
    for (size_t i = 0; i < tables.size(); ++i)
        plotted.push_back({&tables[i], options.labels.empty() ? "" : options.labels[i], ""});
    if (options.labels.empty() && tables.size() > 1)
        for (size_t i = 0; i < tables.size(); ++i)
            plotted[i].label = std::filesystem::path(options.files[i]).stem().string();
    jobs::plot(plotted, request, options.output);

    session.console.result(options.output);
    session.console.document({{"schema", "patina/plot/1"}, {"written", options.output}, {"kind", options.kind}});
    return 0;
}

}  // namespace

void add_plot(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        program.add_subcommand("plot", "draw a BRDF table (several tables overlaid where that makes sense)");
    command->add_option("files", options->files, "BRDF tables (.h5)")->required();
    command->add_option("-o,--output", options->output, "figure to write (.svg or .png)")->required();
    command->add_option("--kind", options->kind, fmt::format("{}", fmt::join(jobs::plot_kind_names(), " | ")))
        ->capture_default_str();
    command->add_option("--theta-i-deg", options->theta_i, "angle of incidence")->capture_default_str();
    command->add_option("--wavelength-nm", options->wavelength, "wavelength")->capture_default_str();
    command->add_option("--label", options->labels, "name of each table in the legend: one,two")->delimiter(',');
    command->add_option("--title", options->title, "title of the figure");
    command->footer("example: patina plot a.h5 b.h5 --label thin,thick -o dolp.svg --kind dolp --theta-i-deg 60");
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
