#include "patina/spectral/text_table.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace patina::spectral {

namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

constexpr std::string_view separators = ",;";

void split_at_separators(std::string_view line, std::vector<TextCell>& cells) {
    for (size_t begin = 0; begin <= line.size();) {
        const size_t end = std::min(line.find_first_of(separators, begin), line.size());
        const std::string_view cell = trimmed(line.substr(begin, end - begin));
        const size_t column = cell.empty() ? begin : static_cast<size_t>(cell.data() - line.data());
        cells.push_back({std::string(cell), static_cast<int>(column) + 1});
        begin = end + 1;
    }
}

void split_at_blanks(std::string_view line, std::vector<TextCell>& cells) {
    for (size_t i = 0; i < line.size();) {
        const size_t begin = i;
        while (i < line.size() && !is_blank(line[i])) ++i;
        if (i > begin) cells.push_back({std::string(line.substr(begin, i - begin)), static_cast<int>(begin) + 1});
        while (i < line.size() && is_blank(line[i])) ++i;
    }
}

// What a message shows of a cell: the user's file may hold anything.
std::string shown(std::string_view text) {
    constexpr size_t longest = 40;
    std::string result;
    for (char c : text.substr(0, longest)) result += static_cast<unsigned char>(c) < 32 ? '?' : c;
    return text.size() > longest ? result + "..." : result;
}

}  // namespace

TextTable split_text_table(std::string_view text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());

    TextTable table;
    int line_number = 0;
    while (!text.empty()) {
        // Take one line, and cut the comment off.
        const size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        ++line_number;
        if (const size_t hash = line.find('#'); hash != std::string_view::npos) {
            table.comments.emplace_back(trimmed(line.substr(hash + 1)));
            line = line.substr(0, hash);
        }
        if (trimmed(line).empty()) continue;

        TextRow row{line_number, {}};
        if (line.find_first_of(separators) != std::string_view::npos)
            split_at_separators(line, row.cells);
        else
            split_at_blanks(line, row.cells);
        table.rows.push_back(std::move(row));
    }
    return table;
}

bool parse_number(std::string_view text, double& number) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} && end == text.data() + text.size() && std::isfinite(number);
}

double number_in(const TextCell& cell, const std::string& file, int line) {
    double number = 0.0;
    if (!parse_number(cell.text, number))
        throw input_error({file, line, cell.column}, fmt::format("\"{}\" is not a finite number", shown(cell.text)));
    return number;
}

void expect_ascending(const std::vector<double>& wavelengths, const TextRow& row, const std::string& file) {
    const size_t n = wavelengths.size();
    if (n < 2 || wavelengths[n - 1] > wavelengths[n - 2]) return;
    const bool twice = wavelengths[n - 1] == wavelengths[n - 2];
    throw input_error({file, row.line, row.cells.front().column},
                      twice ? fmt::format("wavelength {} stands twice", wavelengths[n - 1])
                            : fmt::format("wavelength {} follows {}", wavelengths[n - 1], wavelengths[n - 2]),
                      "wavelengths must ascend", "sort the rows and keep one per wavelength");
}

}  // namespace patina::spectral
