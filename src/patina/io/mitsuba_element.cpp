#include "patina/io/mitsuba_element.h"

#include <cctype>

#include <fmt/format.h>

namespace patina::io {

namespace {

constexpr std::size_t longest_name = 256;
constexpr std::size_t longest_replaced_text = std::size_t{16} << 20;

bool is_name_character(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

}  // namespace

std::vector<std::string> SceneParameters::names() const {
    constexpr std::size_t most_listed = 40;
    std::vector<std::string> list;
    for (const auto& [name, value] : values_) {
        if (list.size() == most_listed) break;
        list.push_back(name);
    }
    return list;
}

std::string SceneParameters::known_name_at(std::string_view text, const SourceLocation& where) const {
    // Take the whole word, in braces or not.
    const bool braces = !text.empty() && text[0] == '{';
    const std::string_view body = braces ? text.substr(1) : text;
    std::size_t length = 0;
    while (length < body.size() && is_name_character(body[length])) ++length;
    if (braces && (length == body.size() || body[length] != '}'))
        throw input_error(where, fmt::format("{} has no closing brace", in_quotes(fmt::format("${}", text))));
    const std::string word(body.substr(0, length));

    // Shorten an unbraced word until it is a known name.
    for (std::size_t size = std::min(length, longest_name); size > 0; --size) {
        if (values_.count(word.substr(0, size)) && (size == length || !braces)) return word.substr(0, size);
        if (braces) break;
    }
    throw input_error(where, fmt::format("parameter {} is not defined", in_quotes("$" + word)),
                      values_.empty() ? "the scene defines none" : "",
                      values_.empty() ? "add <default name=\"...\" value=\"...\"/>" : did_you_mean(word, names()));
}

std::string SceneParameters::replace(std::string_view text, const SourceLocation& where) {
    std::string replaced;
    for (std::size_t at = 0; at < text.size();) {
        if (text[at] != '$') {
            const std::size_t next = std::min(text.find('$', at), text.size());
            replaced += text.substr(at, next - at);
            at = next;
            continue;
        }
        const std::string name = known_name_at(text.substr(at + 1), where);
        const bool braces = at + 1 < text.size() && text[at + 1] == '{';
        at += 1 + name.size() + (braces ? 2 : 0);
        replaced += values_.at(name);
        used_.insert(name);

        // Defaults made of defaults can grow exponentially.
        if (replaced.size() > longest_replaced_text)
            throw input_error(where, "the value is too long after its parameters are replaced");
    }
    return replaced;
}

void SceneParameters::expect_overrides_used(const std::string& scene_file) const {
    for (const auto& [name, value] : overrides_) {
        if (used_.count(name)) continue;
        std::vector<std::string> candidates;
        for (const std::string& known : names())
            if (!overrides_.count(known)) candidates.push_back(known);
        throw input_error({scene_file},
                          fmt::format("parameter {} is given but the scene has no ${}", in_quotes(name), name), "",
                          did_you_mean(name, candidates));
    }
}

LocatedText Element::text(const char* attribute) const {
    const pugi::xml_attribute found = node_.attribute(attribute);
    if (!found) throw input_error(where(), fmt::format("<{}> needs an attribute \"{}\"", node_.name(), attribute));
    const SourceLocation place = file_->where(node_, found);
    return {parameters_->replace(found.value(), place), place};
}

std::string Element::name(const char* attribute) const {
    const LocatedText value = text(attribute);
    if (trimmed(value.text).empty())
        throw input_error(value.where, fmt::format("attribute \"{}\" of <{}> is empty", attribute, node_.name()));
    if (value.text.size() > longest_name)
        throw input_error(value.where, fmt::format("attribute \"{}\" of <{}> is too long", attribute, node_.name()),
                          fmt::format("{} characters, where {} are allowed", value.text.size(), longest_name));
    return value.text;
}

std::string Element::optional_name(const char* attribute) const {
    return has(attribute) ? name(attribute) : std::string{};
}

void Element::expect_no_children() const {
    for (const Element& child : children())
        throw input_error(child.where(), fmt::format("<{}> takes no element inside", node_.name()),
                          fmt::format("{} is", in_quotes(child.tag())));
}

std::vector<Element> Element::children() const {
    std::vector<Element> list;
    for (const pugi::xml_node child : node_.children())
        if (child.type() == pugi::node_element) list.emplace_back(*file_, child, *parameters_);
    return list;
}

}  // namespace patina::io
