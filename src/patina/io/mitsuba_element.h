#pragma once
// One element of a Mitsuba scene file with its $parameters replaced: what the value readers look at.

#include <map>
#include <set>
#include <string>

#include <pugixml.hpp>

#include "patina/io/located_text.h"
#include "patina/io/xml_file.h"

namespace patina::io {

// The values of `<default>` and of the command line. An override wins over every default of the same name.
class SceneParameters {
  public:
    explicit SceneParameters(std::map<std::string, std::string> overrides)
        : overrides_(overrides), values_(std::move(overrides)) {}

    void set_default(const std::string& name, const std::string& value) { values_.emplace(name, value); }

    // `text` with every $name and ${name} replaced. As in Mitsuba, $name ends where the longest known name ends.
    // Throws Error(input) at `where` for an unknown name, listing the known ones.
    std::string replace(std::string_view text, const SourceLocation& where);

    // Throws Error(input) for an override that no file asked for.
    void expect_overrides_used(const std::string& scene_file) const;

  private:
    std::string known_name_at(std::string_view text, const SourceLocation& where) const;
    std::vector<std::string> names() const;

    std::map<std::string, std::string> overrides_;
    std::map<std::string, std::string> values_;
    std::set<std::string> used_;
};

class Element {
  public:
    Element(const XmlFile& file, pugi::xml_node node, SceneParameters& parameters)
        : file_(&file), node_(node), parameters_(&parameters) {}

    const XmlFile& file() const { return *file_; }
    pugi::xml_node node() const { return node_; }
    std::string tag() const { return node_.name(); }
    SourceLocation where() const { return file_->where(node_); }

    bool has(const char* attribute) const { return static_cast<bool>(node_.attribute(attribute)); }
    // Throws Error(input) at the element when the attribute is missing.
    LocatedText text(const char* attribute) const;
    // A name, id or plugin type: not empty and of a sane length.
    std::string name(const char* attribute) const;
    // name(), or "" without the attribute.
    std::string optional_name(const char* attribute) const;

    void expect_attributes(std::initializer_list<const char*> known) const {
        io::expect_attributes(*file_, node_, known);
    }
    void expect_no_children() const;
    std::vector<Element> children() const;

  private:
    const XmlFile* file_;
    pugi::xml_node node_;
    SceneParameters* parameters_;
};

}  // namespace patina::io
