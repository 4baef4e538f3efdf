#include "patina/core/properties.h"

#include <fmt/format.h>

namespace patina {

namespace {

const char* type_name(const PropertyValue& value) {
    static constexpr const char* names[] = {"boolean", "integer", "float", "string", "vector", "transform", "spectrum"};
    return names[value.index()];
}

Error wrong_type(const Properties::Entry& entry, std::string_view expected) {
    return input_error(entry.where, fmt::format("\"{}\" must be a {}", entry.name, expected),
                       fmt::format("it is a {}", type_name(entry.value)));
}

template <class T>
const T& expect_type(const Properties::Entry& entry, std::string_view expected) {
    if (const T* value = std::get_if<T>(&entry.value)) return *value;
    throw wrong_type(entry, expected);
}

double to_number(const Properties::Entry& entry) {
    if (const auto* integer = std::get_if<std::int64_t>(&entry.value)) return static_cast<double>(*integer);
    if (const auto* spectrum = std::get_if<SpectrumSpec>(&entry.value))
        if (spectrum->kind == SpectrumSpec::Kind::uniform) return spectrum->values[0];
    return expect_type<double>(entry, "float");
}

}  // namespace

const Properties::Entry* Properties::find(std::string_view name) const {
    for (const Entry& entry : entries) {
        if (entry.name != name) continue;
        entry.used = true;
        return &entry;
    }
    return nullptr;
}

bool Properties::has(std::string_view name) const {
    for (const Entry& entry : entries)
        if (entry.name == name) return true;
    for (const Child& child : children)
        if (child.name == name) return true;
    return false;
}

double Properties::number(std::string_view name) const {
    if (const Entry* entry = find(name)) return to_number(*entry);
    throw input_error(where, fmt::format("{} \"{}\" needs a float \"{}\"", category, type, name));
}

double Properties::number(std::string_view name, double fallback) const {
    const Entry* entry = find(name);
    return entry ? to_number(*entry) : fallback;
}

std::int64_t Properties::integer(std::string_view name, std::int64_t fallback) const {
    const Entry* entry = find(name);
    return entry ? expect_type<std::int64_t>(*entry, "integer") : fallback;
}

bool Properties::boolean(std::string_view name, bool fallback) const {
    const Entry* entry = find(name);
    return entry ? expect_type<bool>(*entry, "boolean") : fallback;
}

std::string Properties::string(std::string_view name) const {
    if (const Entry* entry = find(name)) return expect_type<std::string>(*entry, "string");
    throw input_error(where, fmt::format("{} \"{}\" needs a string \"{}\"", category, type, name));
}

std::string Properties::string(std::string_view name, std::string_view fallback) const {
    const Entry* entry = find(name);
    return entry ? expect_type<std::string>(*entry, "string") : std::string(fallback);
}

Eigen::Vector3d Properties::vector(std::string_view name, const Eigen::Vector3d& fallback) const {
    const Entry* entry = find(name);
    return entry ? expect_type<Eigen::Vector3d>(*entry, "point or vector") : fallback;
}

Eigen::Matrix4d Properties::transform(std::string_view name, const Eigen::Matrix4d& fallback) const {
    const Entry* entry = find(name);
    return entry ? expect_type<Eigen::Matrix4d>(*entry, "transform") : fallback;
}

std::optional<SpectrumSpec> Properties::spectrum(std::string_view name) const {
    const Entry* entry = find(name);
    if (!entry) return std::nullopt;
    if (std::holds_alternative<SpectrumSpec>(entry->value)) return std::get<SpectrumSpec>(entry->value);
    return SpectrumSpec{SpectrumSpec::Kind::uniform, {}, {to_number(*entry)}};
}

SourceLocation Properties::location_of(std::string_view name) const {
    for (const Entry& entry : entries)
        if (entry.name == name) return entry.where;
    return where;
}

std::vector<std::shared_ptr<const Properties>> Properties::children_of(std::string_view child_category) const {
    std::vector<std::shared_ptr<const Properties>> found;
    for (const Child& child : children) {
        if (child.node->category != child_category) continue;
        child.used = true;
        found.push_back(child.node);
    }
    return found;
}

std::shared_ptr<const Properties> Properties::only_child(std::string_view child_category) const {
    const auto found = children_of(child_category);
    if (found.size() > 1)
        throw input_error(found[1]->where, fmt::format("{} \"{}\" takes one {}", category, type, child_category),
                          fmt::format("{} are given", found.size()));
    return found.empty() ? nullptr : found.front();
}

std::shared_ptr<const Properties> Properties::named_child(std::string_view name) const {
    for (const Child& child : children) {
        if (child.name != name) continue;
        child.used = true;
        return child.node;
    }
    return nullptr;
}

void Properties::expect_all_used(const std::vector<std::string>& known) const {
    for (const Entry& entry : entries) {
        if (entry.used) continue;
        throw input_error(entry.where, fmt::format("unknown property \"{}\" of {} \"{}\"", entry.name, category, type),
                          "", did_you_mean(entry.name, known));
    }
    for (const Child& child : children) {
        if (child.used) continue;
        throw input_error(
            child.node->where,
            fmt::format("{} \"{}\" has no use for a {} \"{}\"{}", category, type, child.node->category,
                        child.node->type, child.name.empty() ? "" : fmt::format(" named \"{}\"", child.name)));
    }
}

}  // namespace patina
