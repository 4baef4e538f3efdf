#pragma once
// A key of a recipe, declared once: the parser, the help page and the machine-readable schema all read this.

#include <limits>
#include <span>
#include <string_view>

namespace patina::coating {

enum class KeyType { number, integer, text, boolean, table, array };

struct KeyInfo {
    std::string_view name;
    KeyType type = KeyType::number;
    std::string_view unit;  // "um", "nm", "1" for a pure number, "" for none
    std::string_view
        fallback;  // the default as written in a recipe, "" when the key is required or its absence has a meaning
    std::string_view doc;  // one line
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool min_excluded = false;
    bool infinite_allowed = false;
};

// One table of a recipe with its keys, e.g. "[[layers.pigments]]".
struct TableInfo {
    std::string_view heading;
    std::string_view doc;
    std::span<const KeyInfo> keys;
};

// Every table a recipe may have, in the order of the manual page (recipe_keys.cpp).
std::span<const TableInfo> recipe_tables();
// The keys of one table by its heading.
std::span<const KeyInfo> recipe_keys(std::string_view heading);

}  // namespace patina::coating
