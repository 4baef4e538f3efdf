#include "patina/coating/number_csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/core/files.h"

namespace patina::coating {

namespace {

constexpr std::uint64_t largest_file = std::uint64_t{64} << 20;

std::string without_blanks(std::string_view line) {
    std::string text;
    for (const char c : line)
        if (c != ' ' && c != '\t' && c != '\r') text += c;
    return text;
}

NumberRow parse_row(const std::string& line, const SourceLocation& where, std::string_view header) {
    const auto columns = static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1;
    NumberRow row{where, std::vector<double>(columns)};
    const char* at = line.data();
    const char* const end = line.data() + line.size();
    for (std::size_t column = 0; column < columns; ++column) {
        const SourceLocation here{where.file, where.line, static_cast<int>(at - line.data()) + 1};
        const auto [stop, status] = std::from_chars(at, end, row.values[column]);
        if (status != std::errc{} || !std::isfinite(row.values[column]))
            throw input_error(here, "a finite number is expected", fmt::format("the columns are {}", header));
        const bool last = column + 1 == columns;
        if (last ? stop != end : (stop == end || *stop != ','))
            throw input_error(here, fmt::format("a row has {} numbers separated by commas", columns),
                              fmt::format("the columns are {}", header));
        at = stop + 1;
    }
    return row;
}

}  // namespace

NumberTable read_number_csv(const std::filesystem::path& path, std::span<const std::string_view> headers) {
    const std::string text = read_text_file(path, largest_file);
    NumberTable table;
    int number = 0;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = without_blanks(std::string_view(text).substr(begin, end - begin));
        begin = end + 1;
        const SourceLocation where{path.string(), ++number, 1};
        if (line.empty() || line.front() == '#') continue;
        if (!table.header.empty()) {
            table.rows.push_back(parse_row(line, where, table.header));
            continue;
        }
        const auto found = std::find(headers.begin(), headers.end(), line);
        if (found == headers.end())
            throw input_error(where, "the header line is missing",
                              fmt::format("it reads {}", fmt::join(headers, " or ")));
        table.header = *found;
    }
    return table;
}

}  // namespace patina::coating
