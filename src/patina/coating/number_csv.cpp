#include "patina/coating/number_csv.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/core/files.h"
#include "patina/spectral/text_table.h"

namespace patina::coating {

namespace {

constexpr std::uint64_t largest_file = std::uint64_t{64} << 20;

// The header a row of words is, as one of `headers`.
std::string_view header_of(const spectral::TextRow& row, std::span<const std::string_view> headers,
                           const SourceLocation& where) {
    std::string found;
    for (const spectral::TextCell& cell : row.cells) found += (found.empty() ? "" : ",") + cell.text;
    const auto header = std::find(headers.begin(), headers.end(), found);
    if (header == headers.end())
        throw input_error(where, "the header line is missing", fmt::format("it reads {}", fmt::join(headers, " or ")));
    return *header;
}

}  // namespace

NumberTable read_number_csv(const std::filesystem::path& path, std::span<const std::string_view> headers) {
    const spectral::TextTable text = spectral::split_text_table(read_text_file(path, largest_file));
    const std::string file = path.string();
    NumberTable table;
    std::size_t columns = 0;
    for (const spectral::TextRow& row : text.rows) {
        const SourceLocation where{file, row.line, 1};
        if (table.header.empty()) {
            table.header = header_of(row, headers, where);
            columns = row.cells.size();
            continue;
        }
        if (row.cells.size() != columns)
            throw input_error(where, fmt::format("{} cells in a row", row.cells.size()),
                              fmt::format("the columns are {}", table.header));
        NumberRow& numbers = table.rows.emplace_back(NumberRow{where, {}});
        for (const spectral::TextCell& cell : row.cells)
            numbers.values.push_back(spectral::number_in(cell, file, row.line));
    }
    return table;
}

}  // namespace patina::coating
