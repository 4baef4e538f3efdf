#pragma once
// Reads one TOML table against its declared keys: types, ranges and unknown keys become errors with line and column.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <toml++/toml.h>

#include "patina/coating/key_info.h"
#include "patina/core/error.h"

namespace patina::coating {

class TableReader {
  public:
    // `path` names the table in messages ("layers.0"). Throws for a key that `keys` does not declare.
    TableReader(const toml::table& table, std::span<const KeyInfo> keys, std::string path, std::string file);

    bool has(std::string_view key) const { return table_.contains(key); }

    // Values in the declared range. The versions without optional throw when the key is missing.
    double number(std::string_view key) const;
    std::optional<double> optional_number(std::string_view key) const;
    std::string text(std::string_view key) const;
    std::optional<std::string> optional_text(std::string_view key) const;
    // An array of numbers, each in the declared range; throws when the key is missing.
    std::vector<double> numbers(std::string_view key) const;
    // One of `choices`, the first when the key is absent.
    std::string choice(std::string_view key, const std::vector<std::string>& choices) const;

    // A sub-table or the tables of an array; null or empty when absent.
    const toml::table* table(std::string_view key) const;
    std::vector<const toml::table*> tables(std::string_view key) const;

    const toml::node* node(std::string_view key) const { return table_.get(key); }
    // Where a key stands, or the table itself when it is absent.
    SourceLocation where(std::string_view key) const;
    SourceLocation where() const;
    std::string path_of(std::string_view key) const {
        return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
    }

    // Throws for the first of `others` that is present: "key" means nothing beside "because".
    void forbid(std::span<const std::string_view> others, std::string_view because) const;

    // A number of this table's or any other node, in [min, max]; for nodes that may be a number or something else.
    double checked_number(const toml::node& node, const KeyInfo& key) const;

    // Throws "`path.key` must be a <expected>" at the key.
    [[noreturn]] void wrong_type(std::string_view key, std::string_view expected) const;

  private:
    const KeyInfo& declared(std::string_view key) const;
    [[noreturn]] void missing(std::string_view key) const;
    SourceLocation location(const toml::source_region& region) const;

    const toml::table& table_;
    std::span<const KeyInfo> keys_;
    std::string path_, file_;
};

}  // namespace patina::coating
