#include <algorithm>
#include <set>

#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/render/render.h"

namespace patina::cli {

namespace {

using render::ParameterDescriptor;
using render::PluginDescriptor;

struct Options {
    std::string word, markdown;
};

// Those named so or of that category; all for no word. Throws Error(usage) with the nearest name when there are none.
std::vector<PluginDescriptor> selected(const std::string& word) {
    if (word.empty()) return render::plugins();
    std::vector<PluginDescriptor> found;
    std::set<std::string> known;
    for (const PluginDescriptor& plugin : render::plugins()) {
        if (plugin.name == word || plugin.category == word) found.push_back(plugin);
        known.insert({plugin.name, plugin.category});
    }
    if (found.empty())
        throw Error(ErrorKind::usage, fmt::format("no plugin or category is named \"{}\"; {}", word,
                                                  did_you_mean(word, {known.begin(), known.end()})));
    return found;
}

// "number, degree"
std::string type_of(const ParameterDescriptor& p) {
    return p.unit.empty() ? p.type : fmt::format("{}, {}", p.type, p.unit);
}

void show_manual(const PluginDescriptor& plugin, Console& console) {
    console.result(fmt::format("<{} type=\"{}\">  {}", plugin.category, plugin.name, plugin.doc));
    if (plugin.parameters.empty()) return;
    console.result(fmt::format("  {:<24} {:<27} {:<22} {:<26} {}", "property", "type", "default", "range", "meaning"));
    for (const ParameterDescriptor& p : plugin.parameters)
        console.result(
            fmt::format("  {:<24} {:<27} {:<22} {:<26} {}", p.name, type_of(p), p.default_value, p.range, p.doc));
    console.result("");
}

void show_list(const std::vector<PluginDescriptor>& plugins, Console& console) {
    std::string category;
    for (const PluginDescriptor& plugin : plugins) {
        if (plugin.category != category) console.result(fmt::format("{}:", category = plugin.category));
        console.result(fmt::format("  {:<20} {}", plugin.name, plugin.doc));
    }
    console.note("patina plugins NAME shows the properties of one");
}

nlohmann::json to_json(const PluginDescriptor& plugin) {
    nlohmann::json parameters = nlohmann::json::array();
    for (const ParameterDescriptor& p : plugin.parameters)
        parameters.push_back({{"name", p.name},
                              {"type", p.type},
                              {"unit", p.unit},
                              {"default", p.default_value},
                              {"range", p.range},
                              {"meaning", p.doc}});
    return {{"category", plugin.category}, {"name", plugin.name}, {"doc", plugin.doc}, {"properties", parameters}};
}

// A cell of a table; the bar would end it.
std::string cell(std::string text) {
    for (size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.replace(at, 1, "\\|");
    return text;
}

// Two names of one thing?
bool are_one(const PluginDescriptor& a, const PluginDescriptor& b) {
    return a.category == b.category && a.doc == b.doc &&
           std::ranges::equal(a.parameters, b.parameters, {}, &ParameterDescriptor::name, &ParameterDescriptor::name);
}

std::string to_markdown(const std::vector<PluginDescriptor>& plugins) {
    std::string page =
        "# Plugins of a scene, and their properties\n\nWritten by `patina plugins --markdown docs/formats/plugins.md`. "
        "What they mean: [scenes](scene.md), [reflection models](../models.md).\n";
    std::string category;
    for (size_t i = 0; i < plugins.size(); ++i) {
        const PluginDescriptor& plugin = plugins[i];
        if (plugin.category != category) page += fmt::format("\n## {}\n", category = plugin.category);
        page += fmt::format("{}`{}`", i > 0 && are_one(plugins[i - 1], plugin) ? ", " : "\n### ", plugin.name);
        if (i + 1 < plugins.size() && are_one(plugin, plugins[i + 1])) continue;
        page += fmt::format("\n\n{}\n", plugin.doc);
        if (!plugin.parameters.empty())
            page += "\n| property | type | default | range | meaning |\n|---|---|---|---|---|\n";
        for (const ParameterDescriptor& p : plugin.parameters)
            page += fmt::format("| `{}` | {} | {} | {} | {} |\n", p.name, cell(type_of(p)), cell(p.default_value),
                                cell(p.range), cell(p.doc));
    }
    return page;
}

int run(const Options& options, Session& session) {
    const std::vector<PluginDescriptor> plugins = selected(options.word);
    const bool one_name = !options.word.empty() && plugins.front().name == options.word;
    if (one_name)
        for (const PluginDescriptor& plugin : plugins) show_manual(plugin, session.console);
    else
        show_list(plugins, session.console);

    nlohmann::json rows = nlohmann::json::array();
    for (const PluginDescriptor& plugin : plugins) rows.push_back(to_json(plugin));
    session.console.document({{"schema", "patina/plugins/1"}, {"plugins", rows}});

    if (!options.markdown.empty()) write_text_file(options.markdown, to_markdown(plugins));
    return 0;
}

}  // namespace

void add_plugins(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand(
        "plugins", "what a scene can be made of: surfaces, lamps, cameras, integrators ... and their properties");
    command->add_option("name", options->word, "a plugin or a category: roughconductor, integrator; none: all");
    command->add_option("--markdown", options->markdown, "also write the manual to this file");
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
