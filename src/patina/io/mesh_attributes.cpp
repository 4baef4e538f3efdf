#include "patina/io/mesh_attributes.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace patina::io {

namespace {

using Columns = std::vector<std::size_t>;

// The columns of these names, when all are there.
std::optional<Columns> columns_called(const std::vector<std::string>& names, const std::array<const char*, 3>& wanted) {
    Columns columns;
    for (const char* name : wanted) {
        const auto found = std::ranges::find(names, name);
        if (found == names.end()) return std::nullopt;
        columns.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    return columns;
}

// The column that follows a first one, "speed_x" for instance, as its channel number `channel`.
std::string sibling(const std::string& first, std::size_t channel) {
    constexpr std::array<std::string_view, 4> kinds{"xyzw", "rgba", "0123", "1234"};
    if (first.size() < 3 || first[first.size() - 2] != '_') return {};
    for (const std::string_view kind : kinds)
        if (first.back() == kind[0]) return first.substr(0, first.size() - 1) + kind[channel];
    return {};
}

}  // namespace

std::vector<AttributeColumns> group_attributes(const std::vector<std::string>& names, const std::string& prefix) {
    std::vector<AttributeColumns> groups;
    std::vector<std::string> left = names;
    const auto take = [&](const std::string& name, Columns columns, bool colour) {
        for (const std::size_t column : columns) left[column].clear();
        groups.push_back({prefix + name, std::move(columns), colour});
    };
    for (const auto& wanted : {std::array{"red", "green", "blue"}, std::array{"r", "g", "b"}})
        if (auto columns = columns_called(names, wanted)) {
            for (const char* opacity : {"alpha", "a"}) std::ranges::replace(left, std::string(opacity), std::string());
            take("color", std::move(*columns), true);
            break;
        }
    for (std::size_t i = 0; i < left.size(); ++i) {
        const std::string first = left[i];
        if (first.empty()) continue;
        const std::string second = sibling(first, 1), third = sibling(first, 2), fourth = sibling(first, 3);
        const auto follows = [&](std::size_t step, const std::string& name) {
            return !name.empty() && i + step < left.size() && left[i + step] == name;
        };
        const std::string stem = second.empty() ? first : first.substr(0, first.size() - 2);
        const bool colour = !second.empty() && first.back() == 'r';
        const std::string name = colour ? stem + "_color" : stem;
        if (!follows(1, second) || !follows(2, third)) {
            take(follows(1, second) ? first : name, {i}, false);
            continue;
        }
        if (follows(3, fourth)) left[i + 3].clear();
        take(name, {i, i + 1, i + 2}, colour);
    }
    return groups;
}

}  // namespace patina::io
