#include <filesystem>

#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/jobs/starters.h"

namespace patina::cli {

namespace {

struct Options {
    std::string kind, name;
};

int run(const Options& options, Session& session) {
    const bool paint = options.kind == "paint";
    std::filesystem::path path = options.name;
    if (!path.has_extension()) path += paint ? ".toml" : ".xml";
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored))
        throw Error(ErrorKind::runtime, fmt::format("{}: exists already", path.string()));
    write_text_file(path, paint ? jobs::starter_recipe() : jobs::starter_scene());
    session.console.result(path.string());
    session.console.document({{"schema", "patina/new/1"}, {"written", path.string()}});
    session.console.hint(paint
                             ? fmt::format("patina solve {} -o {}.h5", path.string(), path.stem().string())
                             : fmt::format("patina render {} -o {}.exr --spp 64", path.string(), path.stem().string()));
    return 0;
}

}  // namespace

void add_new(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand("new", "write a commented starter file");
    command->add_option("kind", options->kind, "paint | scene")->required()->check(CLI::IsMember({"paint", "scene"}));
    command->add_option("name", options->name, "file to write")->required();
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
