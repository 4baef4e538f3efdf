// What a scene can be made of, as the program tells it.

#include "run_patina.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patina::test {
namespace {

using ::testing::HasSubstr;
class Plugins : public PatinaTest {};

TEST_F(Plugins, TheManualInTheDocsIsCurrent) {
    ASSERT_EQ(patina("plugins --markdown plugins.md").exit_code, 0);
    EXPECT_EQ(read_file(folder() / "plugins.md"),
              read_file(fs::path(PATINA_SOURCE_DIR) / "docs" / "formats" / "plugins.md"))
        << "write it again: patina plugins --markdown docs/formats/plugins.md";
}

TEST_F(Plugins, EveryPropertyHasATypeAndAMeaning) {
    const auto document = nlohmann::json::parse(patina("plugins --json").out);
    ASSERT_GT(document["plugins"].size(), 60u);
    for (const auto& plugin : document["plugins"]) {
        EXPECT_FALSE(plugin["doc"].get<std::string>().empty()) << plugin["name"];
        for (const auto& property : plugin["properties"]) {
            EXPECT_FALSE(property["type"].get<std::string>().empty()) << plugin["name"] << property["name"];
            EXPECT_FALSE(property["meaning"].get<std::string>().empty()) << plugin["name"] << property["name"];
        }
    }
}

TEST_F(Plugins, OneIsShownByNameAndManyByCategory) {
    EXPECT_THAT(patina("plugins roughconductor").out, HasSubstr("alpha_u"));
    const std::string integrators = patina("plugins integrator").out;
    for (const char* name : {"path", "bidirectional", "radiosity"}) EXPECT_THAT(integrators, HasSubstr(name));
    EXPECT_THAT(integrators, ::testing::Not(HasSubstr("roughconductor")));
    const Outcome wrong = patina("plugins roughconducter");
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.err, HasSubstr("did you mean \"roughconductor\"?"));
}

// A script that keeps the output on a full disk learns of it, however little there is to be written; `head`, which has
// seen enough, is told nothing.
TEST_F(Plugins, SayThatTheStandardOutputIsLost) {
    const auto run = [&](const std::string& words) {
        const std::string command = "{ '" + std::string(PATINA_BINARY) + "' " + words + "; echo $? >&2; } 2>'" +
                                    (folder() / "err").string() + "'";
        EXPECT_EQ(std::system(command.c_str()), 0);
        return read_file(folder() / "err");
    };
    EXPECT_EQ(run("plugins >/dev/full"), "error: the standard output cannot be written (No space left on device)\n1\n");
    EXPECT_EQ(run("plugins diffuse >/dev/full"),
              "error: the standard output cannot be written (No space left on device)\n1\n");
    EXPECT_EQ(run("plugins --json | true").find("error"), std::string::npos);
}

}  // namespace
}  // namespace patina::test
