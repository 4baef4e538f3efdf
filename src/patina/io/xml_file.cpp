#include "patina/io/xml_file.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "patina/io/located_text.h"

namespace patina::io {

XmlFile::XmlFile(std::string text, std::string name) : name_(std::move(name)), text_(std::move(text)) {
    // Note the lines before the parser rewrites the text in place.
    line_starts_.push_back(0);
    for (std::size_t i = 0; i < text_.size(); ++i)
        if (text_[i] == '\n') line_starts_.push_back(static_cast<std::ptrdiff_t>(i) + 1);

    // Refuse what cannot be UTF-8 text: the parser would stop at a NUL in silence.
    if (const std::size_t nul = text_.find('\0'); nul != std::string::npos)
        throw input_error(where(static_cast<std::ptrdiff_t>(nul)), "not an XML file", "it holds a NUL byte",
                          "save it as UTF-8 text");
    if (trimmed(text_).empty()) throw input_error({name_}, "the file is empty");

    const pugi::xml_parse_result result =
        document_.load_buffer_inplace(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result) throw input_error(where(result.offset), "not well-formed XML", result.description());

    for (const pugi::xml_node node : document_.children()) {
        if (node.type() != pugi::node_element) continue;
        if (root_) throw input_error(where(node), fmt::format("a second top-level element {}", in_quotes(node.name())));
        root_ = node;
    }
    if (!root_) throw input_error({name_}, "the file has no element");
}

SourceLocation XmlFile::where(std::ptrdiff_t offset) const {
    const std::ptrdiff_t inside = std::clamp<std::ptrdiff_t>(offset, 0, static_cast<std::ptrdiff_t>(text_.size()));
    const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), inside);
    const auto line = after - line_starts_.begin();
    return {name_, static_cast<int>(line), static_cast<int>(inside - *(after - 1)) + 1};
}

SourceLocation XmlFile::where(pugi::xml_node node) const {
    // The parser's offset is that of the name; people count from the bracket before it.
    return where(std::max<std::ptrdiff_t>(node.offset_debug() - 1, 0));
}

SourceLocation XmlFile::where(pugi::xml_node node, pugi::xml_attribute attribute) const {
    const char* begin = text_.data();
    const char* value = attribute.value();
    const bool inside = !std::less<>{}(value, begin) && std::less<>{}(value, begin + text_.size());
    return attribute && inside ? where(value - begin) : where(node);
}

void expect_attributes(const XmlFile& file, pugi::xml_node node, std::initializer_list<const char*> known) {
    const std::vector<std::string> names(known.begin(), known.end());
    std::vector<bool> seen(names.size(), false);
    for (const pugi::xml_attribute attribute : node.attributes()) {
        const auto found = std::find(names.begin(), names.end(), attribute.name());
        if (found == names.end())
            throw input_error(file.where(node, attribute),
                              fmt::format("<{}> has no attribute {}", node.name(), in_quotes(attribute.name())), "",
                              did_you_mean(attribute.name(), names));
        const auto index = static_cast<std::size_t>(found - names.begin());
        if (seen[index])
            throw input_error(file.where(node, attribute), fmt::format("attribute {} of <{}> is given twice",
                                                                       in_quotes(attribute.name()), node.name()));
        seen[index] = true;
    }
    for (const pugi::xml_node child : node.children()) {
        if (child.type() != pugi::node_pcdata && child.type() != pugi::node_cdata) continue;
        if (!trimmed(child.value()).empty())
            throw input_error(file.where(child),
                              fmt::format("text {} inside <{}>", in_quotes(child.value()), node.name()),
                              "a scene file has elements and attributes only");
    }
}

}  // namespace patina::io
