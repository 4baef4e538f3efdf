#pragma once
// One subcommand a file; each adds itself to the program and runs as a function that returns the exit code.

#include <functional>
#include <string>
#include <vector>

#include "console.h"
#include <CLI/CLI.hpp>

#include "patina/core/progress.h"

namespace patina::cli {

// What every command runs with.
struct Session {
    Console console;
    CancelToken cancel;
    std::string command_line;     // as typed, for provenance
    std::function<int()> chosen;  // the parsed subcommand, called by main

    JobControl control() { return {console.progress(), &cancel}; }
};

// The commands, in the order of `patina --help`.
void add_solve(CLI::App& program, Session& session);
void add_field(CLI::App& program, Session& session);
void add_render(CLI::App& program, Session& session);
void add_paint(CLI::App& program, Session& session);
void add_sweep(CLI::App& program, Session& session);
void add_compare(CLI::App& program, Session& session);
void add_plot(CLI::App& program, Session& session);
void add_image(CLI::App& program, Session& session);
void add_inspect(CLI::App& program, Session& session);
void add_check(CLI::App& program, Session& session);
void add_materials(CLI::App& program, Session& session);
void add_scattering(CLI::App& program, Session& session);
void add_plugins(CLI::App& program, Session& session);
void add_new(CLI::App& program, Session& session);
void add_convert(CLI::App& program, Session& session);
void add_validate(CLI::App& program, Session& session);

// Numbers of a list "0,10:20:5,45": single values and begin:end:step ranges, both ends included.
// Throws Error(usage) naming `option` for anything else.
std::vector<double> parse_number_list(const std::string& text, std::string_view option);

}  // namespace patina::cli
