#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/jobs/inspect.h"

namespace patina::cli {

namespace {

int run(const std::string& file, Session& session) {
    const std::vector<jobs::Fact> facts = jobs::inspect(file);
    nlohmann::json document = {{"schema", "patina/inspect/1"}, {"file", file}, {"facts", nlohmann::json::object()}};
    for (const jobs::Fact& fact : facts) {
        session.console.result(fmt::format("{:<22} {}", fact.name, fact.value));
        document["facts"][fact.name] = fact.value;
    }
    session.console.document(document);
    return 0;
}

}  // namespace

void add_inspect(CLI::App& program, Session& session) {
    auto file = std::make_shared<std::string>();
    CLI::App* command =
        program.add_subcommand("inspect", "say what a file is: axes, conventions, ranges, and how to make it again");
    command->add_option("file", *file, "BRDF table, picture, recipe or material file")->required();
    command->callback([file, &session] { session.chosen = [file, &session] { return run(*file, session); }; });
}

}  // namespace patina::cli
