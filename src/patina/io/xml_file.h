#pragma once
// An XML file in memory in which every element and every attribute knows its line and column.

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include "patina/core/error.h"

namespace patina::io {

class XmlFile {
  public:
    // Parses `text` (UTF-8). Throws Error(input) at the place where it stops being well-formed XML. Document types are
    // skipped and entities beyond XML's own five are never expanded.
    XmlFile(std::string text, std::string name);
    XmlFile(const XmlFile&) = delete;
    XmlFile& operator=(const XmlFile&) = delete;

    const std::string& name() const { return name_; }

    // The only top-level element.
    pugi::xml_node root() const { return root_; }

    SourceLocation where(pugi::xml_node node) const;
    // Where the attribute's value starts.
    SourceLocation where(pugi::xml_node node, pugi::xml_attribute attribute) const;

  private:
    SourceLocation where(std::ptrdiff_t offset) const;

    std::string name_;
    std::string text_;  // parsed in place: names and values point into it
    std::vector<std::ptrdiff_t> line_starts_;
    pugi::xml_document document_;
    pugi::xml_node root_;
};

// Throws Error(input) for an attribute not in `known` or given twice, and for text inside the element.
void expect_attributes(const XmlFile& file, pugi::xml_node node, std::initializer_list<const char*> known);

}  // namespace patina::io
