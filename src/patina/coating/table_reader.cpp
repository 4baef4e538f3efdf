#include "patina/coating/table_reader.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/core/contract.h"

namespace patina::coating {

namespace {

const char* type_name(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "a boolean";
        default:
            return "a date";
    }
}

std::string with_unit(double value, const KeyInfo& key) {
    return key.unit.empty() || key.unit == "1" ? fmt::format("{:g}", value) : fmt::format("{:g} {}", value, key.unit);
}

// "it must be above 0 and at most 0.74".
std::string range_text(const KeyInfo& key) {
    const std::string lower = fmt::format("{} {}", key.min_excluded ? "above" : "at least", with_unit(key.min, key));
    return std::isinf(key.max) ? lower : fmt::format("{} and at most {}", lower, with_unit(key.max, key));
}

}  // namespace

TableReader::TableReader(const toml::table& table, std::span<const KeyInfo> keys, std::string path, std::string file)
    : table_(table), keys_(keys), path_(std::move(path)), file_(std::move(file)) {
    for (const auto& [key, value] : table_) {
        const bool known =
            std::any_of(keys_.begin(), keys_.end(), [&](const KeyInfo& info) { return info.name == key.str(); });
        if (known) continue;
        std::vector<std::string> names;
        for (const KeyInfo& info : keys_) names.emplace_back(info.name);
        throw input_error(location(key.source()), fmt::format("unknown key \"{}\"", path_of(key.str())), "",
                          did_you_mean(key.str(), names));
    }
}

double TableReader::number(std::string_view key) const {
    const std::optional<double> value = optional_number(key);
    if (!value) missing(key);
    return *value;
}

std::optional<double> TableReader::optional_number(std::string_view key) const {
    const toml::node* value = table_.get(key);
    if (!value) return std::nullopt;
    return checked_number(*value, declared(key));
}

double TableReader::checked_number(const toml::node& node, const KeyInfo& key) const {
    const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value) wrong_type(key.name, "number");
    const bool above = key.min_excluded ? *value > key.min : *value >= key.min;
    const bool finite_enough = std::isfinite(*value) || (key.infinite_allowed && *value > 0);
    if (above && *value <= key.max && finite_enough) return *value;

    const std::string nearest = std::isnan(*value)  ? ""
                                : *value > key.max  ? fmt::format("; the nearest legal value is {:g}", key.max)
                                : !key.min_excluded ? fmt::format("; the nearest legal value is {:g}", key.min)
                                                    : "";
    throw input_error(location(node.source()), fmt::format("{} = {:g} is out of range", path_of(key.name), *value),
                      fmt::format("it must be {}{}", range_text(key), nearest));
}

std::string TableReader::text(std::string_view key) const {
    std::optional<std::string> value = optional_text(key);
    if (!value) missing(key);
    return *std::move(value);
}

std::optional<std::string> TableReader::optional_text(std::string_view key) const {
    const toml::node* value = table_.get(key);
    if (!value) return std::nullopt;
    if (!value->is_string()) wrong_type(key, "string");
    return value->value<std::string>();
}

std::vector<double> TableReader::numbers(std::string_view key) const {
    const toml::node* value = table_.get(key);
    if (!value) missing(key);
    if (!value->is_array()) wrong_type(key, "array of numbers");
    std::vector<double> values;
    for (const toml::node& element : *value->as_array()) values.push_back(checked_number(element, declared(key)));
    return values;
}

std::string TableReader::choice(std::string_view key, const std::vector<std::string>& choices) const {
    PATINA_EXPECT(!choices.empty());
    const std::optional<std::string> value = optional_text(key);
    if (!value) return choices.front();
    if (std::find(choices.begin(), choices.end(), *value) != choices.end()) return *value;
    throw input_error(where(key), fmt::format("{} = \"{}\" is not known", path_of(key), *value),
                      fmt::format("it is one of {}", fmt::join(choices, ", ")), did_you_mean(*value, choices, false));
}

const toml::table* TableReader::table(std::string_view key) const {
    const toml::node* value = table_.get(key);
    if (!value) return nullptr;
    if (!value->is_table()) wrong_type(key, "table");
    return value->as_table();
}

std::vector<const toml::table*> TableReader::tables(std::string_view key) const {
    std::vector<const toml::table*> found;
    const toml::node* value = table_.get(key);
    if (!value) return found;
    if (!value->is_array()) wrong_type(key, "array of tables");
    for (const toml::node& element : *value->as_array()) {
        if (!element.is_table()) wrong_type(key, "array of tables");
        found.push_back(element.as_table());
    }
    return found;
}

SourceLocation TableReader::where(std::string_view key) const {
    const toml::node* value = table_.get(key);
    return value ? location(value->source()) : where();
}

SourceLocation TableReader::where() const {
    return location(table_.source());
}

void TableReader::forbid(std::span<const std::string_view> others, std::string_view because) const {
    for (const std::string_view other : others) {
        if (!has(other)) continue;
        throw input_error(where(other), fmt::format("{} has no meaning here", path_of(other)), because);
    }
}

void TableReader::wrong_type(std::string_view key, std::string_view expected) const {
    const toml::node* value = table_.get(key);
    throw input_error(where(key), fmt::format("{} must be a {}", path_of(key), expected),
                      value ? fmt::format("it is {}", type_name(*value)) : "");
}

const KeyInfo& TableReader::declared(std::string_view key) const {
    for (const KeyInfo& info : keys_)
        if (info.name == key) return info;
    throw ContractViolation("precondition", "the key is declared in recipe_keys.cpp", __FILE__, __LINE__);
}

void TableReader::missing(std::string_view key) const {
    throw input_error(where(), fmt::format("{} is missing", path_of(key)), declared(key).doc);
}

SourceLocation TableReader::location(const toml::source_region& region) const {
    return {file_, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

}  // namespace patina::coating
