#pragma once
// Tables of a fixed header and rows of finite numbers, CSV or separated by white space.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "patina/core/error.h"

namespace patina::coating {

struct NumberRow {
    SourceLocation where;
    std::vector<double> values;  // one a column
};

struct NumberTable {
    std::string_view header;  // the one of `headers` that was found
    std::vector<NumberRow> rows;
};

// The header is one of `headers`, written with commas there; '#' starts a comment. Throws Error(input) with line and
// column for another header, a cell that is not a finite number, a row of another length.
NumberTable read_number_csv(const std::filesystem::path& path, std::span<const std::string_view> headers);

}  // namespace patina::coating
