#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/jobs/convert.h"

namespace patina::cli {

namespace {

struct Options {
    std::string input, output, wavelengths, grid;
};

// "73x46x64": phi_d, theta_d, theta_h.
void parse_grid(const std::string& text, jobs::ConvertRequest& request) {
    int length = 0;
    if (std::sscanf(text.c_str(), "%4dx%4dx%4d%n", &request.phi_d, &request.theta_d, &request.theta_h, &length) != 3 ||
        length != std::ssize(text))
        throw Error(ErrorKind::usage,
                    fmt::format("--grid {}: three numbers PHI_DxTHETA_DxTHETA_H are expected, as 73x46x64", text));
    for (const int count : {request.phi_d, request.theta_d, request.theta_h})
        if (count < 2 || count > 1000)
            throw Error(ErrorKind::usage, fmt::format("--grid {}: 2 to 1000 points an axis make sense", text));
}

nlohmann::json to_json(const Options& options, const jobs::ConvertResult& result) {
    nlohmann::json error = nullptr;
    if (result.error.directions > 0)
        error = {{"of", result.error.of},
                 {"directions", result.error.directions},
                 {"largest", result.error.largest},
                 {"rms", result.error.rms},
                 {"largest_value", result.error.scale}};
    return {{"schema", "patina/convert/1"},
            {"input", options.input},
            {"output", options.output},
            {"wavelengths_nm", result.wavelengths_nm},
            {"error", error},
            {"notes", result.notes}};
}

int run(const Options& options, Session& session) {
    jobs::ConvertRequest request{options.input, options.output};
    if (!options.wavelengths.empty()) request.wavelengths_nm = parse_number_list(options.wavelengths, "--wavelengths");
    if (!options.grid.empty()) parse_grid(options.grid, request);
    expect_writable(options.output);
    const jobs::ConvertResult result = jobs::convert(request);

    Console& console = session.console;
    for (const std::string& note : result.notes) console.note("note: " + note);
    console.result(fmt::format("{}: {} wavelengths from {:g} to {:g} nm", options.output, result.wavelengths_nm.size(),
                               result.wavelengths_nm.front(), result.wavelengths_nm.back()));
    if (const jobs::ConversionError& error = result.error; error.directions > 0)
        console.result(
            fmt::format("read back, {} differ from the input by {:.2e} 1/sr at most and {:.2e} rms (largest value "
                        "{:.3g}; {} random directions up to 80 deg)",
                        error.of, error.largest, error.rms, error.scale, error.directions));
    console.document(to_json(options, result));
    return 0;
}

}  // namespace

void add_convert(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand(
        "convert", "a BRDF table in another format, by extension: .h5, .pbsdf (Mitsuba 3), .binary (MERL), .csv");
    command->add_option("input", options->input, "BRDF table (.h5 or .pbsdf)")->required();
    command->add_option("output", options->output, "file to write (.h5, .pbsdf, .binary or .csv)")->required();
    command->add_option("--wavelengths", options->wavelengths,
                        "wavelengths of the output in nm: 450,500,550 or 400:700:20");
    command->add_option("--grid", options->grid, "grid of a .pbsdf: PHI_DxTHETA_DxTHETA_H (default 73x46x64)");
    command->footer("example: patina convert tio2.h5 tio2.pbsdf");
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
