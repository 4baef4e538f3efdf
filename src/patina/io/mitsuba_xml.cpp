#include "patina/io/mitsuba_xml.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "patina/core/files.h"
#include "patina/io/mitsuba_element.h"
#include "patina/io/mitsuba_references.h"
#include "patina/io/mitsuba_values.h"

namespace patina::io {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t largest_scene_bytes = std::uint64_t{256} << 20;
constexpr int deepest_nesting = 64;
constexpr std::size_t deepest_include = 16;
constexpr int most_includes = 1000;
constexpr std::size_t most_properties = 1000;

const std::vector<std::string>& plugin_tags() {
    static const std::vector<std::string> tags{"integrator", "sensor",  "film",    "sampler", "rfilter", "shape",
                                               "bsdf",       "emitter", "texture", "medium",  "phase",   "volume"};
    return tags;
}

bool contains(const std::vector<std::string>& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

class SceneReader {
  public:
    explicit SceneReader(const std::map<std::string, std::string>& parameters) : parameters_(parameters) {}

    std::shared_ptr<const Properties> read(std::string text, const fs::path& path) {
        auto scene = std::make_shared<Properties>();
        scene->category = scene->type = "scene";
        scene_folder_ = path.parent_path();
        scene->where = {path.string(), 1, 1};
        read_file(std::move(text), path, *scene);
        parameters_.expect_overrides_used(path.string());
        references_.resolve(*scene);
        return scene;
    }

  private:
    void read_file(std::string text, const fs::path& path, Properties& scene);
    void check_root(const Element& root);
    void read_children(const Element& parent, Properties& node, int depth);
    void read_child(const Element& child, Properties& node, int depth);
    bool read_directive(const Element& element, Properties& node);
    void read_include(const Element& element, Properties& node);
    void read_entry(const Element& element, PropertyValue value, Properties& node);
    void read_plugin(const Element& element, Properties& node, int depth);

    std::optional<fs::path> find_file(const LocatedText& name) const;
    fs::path expect_file(const LocatedText& name) const;

    SceneParameters parameters_;
    SceneReferences references_;
    std::unordered_map<const Properties*, std::unordered_set<std::string>> names_;  // of the properties of each node
    fs::path scene_folder_;
    std::vector<fs::path> search_folders_;  // of <path>, the latest first
    std::vector<fs::path> open_files_;      // canonical, outermost first
    int include_count_ = 0;
};

void SceneReader::read_file(std::string text, const fs::path& path, Properties& scene) {
    // Refuse a file that is being read already.
    std::error_code unknown;
    const fs::path canonical = fs::weakly_canonical(path, unknown);
    open_files_.push_back(unknown ? path : canonical);

    const XmlFile file(std::move(text), path.string());
    const Element root(file, file.root(), parameters_);
    check_root(root);
    if (open_files_.size() == 1) scene.where = root.where();
    read_children(root, scene, 1);
    open_files_.pop_back();
}

void SceneReader::check_root(const Element& root) {
    if (root.tag() != "scene")
        throw input_error(root.where(), fmt::format("the file starts with {}", in_quotes("<" + root.tag() + ">")),
                          "a scene file has one <scene version=\"3.0.0\">");
    root.expect_attributes({"version", "id", "type"});
    const LocatedText version = root.text("version");
    const std::string_view number = trimmed(version.text);
    const std::int64_t major = parse_integer(number.substr(0, number.find('.')), version.where, "version");
    if (major == 2 || major == 3) return;
    throw input_error(version.where, fmt::format("scene version {} is not supported", in_quotes(version.text)),
                      major < 2 ? "the names of Mitsuba 0.x differ" : "it is newer than this reader",
                      "supported: 2.x and 3.x");
}

void SceneReader::read_children(const Element& parent, Properties& node, int depth) {
    if (depth > deepest_nesting)
        throw input_error(parent.where(), "elements are nested too deeply",
                          fmt::format("at most {} levels are", deepest_nesting));
    for (const Element& child : parent.children()) read_child(child, node, depth);
}

void SceneReader::read_child(const Element& child, Properties& node, int depth) {
    if (read_directive(child, node)) return;
    const FileResolver resolve = [this](const LocatedText& name) { return expect_file(name); };
    if (child.tag() == "animation") {
        const std::string name = child.name("name");
        if (node.has(name) || node.children.size() >= most_properties)
            throw input_error(child.where(), fmt::format("property {} is given twice", in_quotes(name)));
        node.children.push_back({name, read_animation(child)});
        return;
    }
    if (child.tag() == "transform" && child.has("time"))
        throw input_error(child.where(), "only the transforms of an <animation> have a time");
    if (auto value = read_property(child, resolve)) return read_entry(child, std::move(*value), node);
    if (contains(plugin_tags(), child.tag())) return read_plugin(child, node, depth);

    std::vector<std::string> known = property_tags();
    known.insert(known.end(), plugin_tags().begin(), plugin_tags().end());
    for (const char* directive : {"default", "include", "ref", "alias", "path", "animation"})
        known.emplace_back(directive);
    throw input_error(child.where(), fmt::format("unknown element {}", in_quotes("<" + child.tag() + ">")), "",
                      did_you_mean(child.tag(), known));
}

bool SceneReader::read_directive(const Element& element, Properties& node) {
    const std::string tag = element.tag();
    if (tag == "default") {
        element.expect_attributes({"name", "value"});
        element.expect_no_children();
        parameters_.set_default(element.name("name"), element.text("value").text);
    } else if (tag == "include") {
        element.expect_attributes({"filename"});
        element.expect_no_children();
        read_include(element, node);
    } else if (tag == "path") {
        element.expect_attributes({"value"});
        const LocatedText value = element.text("value");
        const fs::path folder = fs::path(value.where.file).parent_path() / value.text;
        std::error_code status_error;
        if (!fs::is_directory(folder, status_error))
            throw input_error(value.where, fmt::format("there is no folder {}", in_quotes(folder.string())));
        search_folders_.insert(search_folders_.begin(), folder);
    } else if (tag == "ref") {
        element.expect_attributes({"id", "name"});
        element.expect_no_children();
        references_.refer(node, element.optional_name("name"), element.name("id"), element.where());
    } else if (tag == "alias") {
        element.expect_attributes({"id", "as"});
        element.expect_no_children();
        references_.define_alias(element.text("id"), element.text("as"));
    } else {
        return false;
    }
    return true;
}

void SceneReader::read_include(const Element& element, Properties& node) {
    const LocatedText name = element.text("filename");
    if (node.category != "scene")
        throw input_error(element.where(), "<include> stands inside a plugin", "", "move it to the top of the scene");
    const fs::path path = expect_file(name);
    std::error_code unknown;
    const fs::path canonical = fs::weakly_canonical(path, unknown);
    if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
        throw input_error(name.where, fmt::format("{} includes itself", in_quotes(path.string())),
                          "directly or by way of others");
    if (open_files_.size() >= deepest_include || ++include_count_ > most_includes)
        throw input_error(name.where, "too many includes",
                          fmt::format("at most {} deep and {} in all", deepest_include, most_includes));
    read_file(read_text_file(path, largest_scene_bytes), path, node);
}

void SceneReader::read_entry(const Element& element, PropertyValue value, Properties& node) {
    const std::string name = element.name("name");
    if (!names_[&node].insert(name).second)
        throw input_error(element.where(), fmt::format("property {} is given twice", in_quotes(name)));
    if (node.entries.size() >= most_properties)
        throw input_error(element.where(), "too many properties",
                          fmt::format("a plugin has at most {}", most_properties));

    // Resolve what names a file.
    if (auto* text = std::get_if<std::string>(&value)) {
        const LocatedText located = element.text("value");
        // A film's filename, of older files, is one to be written.
        const bool names_file = name == "filename" || name == "recipe" || name == "table";
        if (names_file && node.category != "film") *text = expect_file(located).string();
        if (name == "material")
            if (const auto found = find_file(located)) *text = found->string();
    }
    node.entries.push_back({name, std::move(value), element.where()});
}

void SceneReader::read_plugin(const Element& element, Properties& node, int depth) {
    element.expect_attributes({"type", "id", "name"});
    auto plugin = std::make_shared<Properties>();
    plugin->category = element.tag();
    plugin->type = element.name("type");
    plugin->id = element.optional_name("id");
    plugin->where = element.where();
    if (!plugin->id.empty()) references_.define(plugin->id, plugin, element.text("id").where);
    node.children.push_back({element.optional_name("name"), plugin});
    read_children(element, *plugin, depth + 1);
}

std::optional<fs::path> SceneReader::find_file(const LocatedText& name) const {
    constexpr std::size_t longest_path = 4096;
    if (name.text.empty() || name.text.size() > longest_path) return std::nullopt;
    std::vector<fs::path> folders{fs::path(name.where.file).parent_path(), scene_folder_};
    folders.insert(folders.end(), search_folders_.begin(), search_folders_.end());
    for (const fs::path& folder : folders) {
        std::error_code status_error;
        const fs::path candidate = folder / name.text;
        if (fs::is_regular_file(candidate, status_error)) return fs::absolute(candidate).lexically_normal();
    }
    return std::nullopt;
}

fs::path SceneReader::expect_file(const LocatedText& name) const {
    if (const auto found = find_file(name)) return *found;
    const fs::path beside = fs::path(name.where.file).parent_path();
    std::string searched = beside.empty() ? "the current folder" : in_quotes(beside.string());
    for (const fs::path& folder : search_folders_) searched += ", " + in_quotes(folder.string());
    std::error_code status_error;
    if (name.text.size() < 4096 && fs::exists(beside / name.text, status_error))
        throw input_error(name.where, fmt::format("{} is no file", in_quotes(name.text)),
                          "it is a folder, a pipe or a device");
    throw input_error(name.where, fmt::format("there is no file {}", in_quotes(name.text)), "looked in " + searched);
}

}  // namespace

std::shared_ptr<const Properties> parse_mitsuba_scene(std::string text, const fs::path& path,
                                                      const std::map<std::string, std::string>& parameters) {
    return SceneReader(parameters).read(std::move(text), path);
}

std::shared_ptr<const Properties> read_mitsuba_scene(const fs::path& path,
                                                     const std::map<std::string, std::string>& parameters) {
    return parse_mitsuba_scene(read_text_file(path, largest_scene_bytes), path, parameters);
}

}  // namespace patina::io
