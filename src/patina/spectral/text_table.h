#pragma once
// Tables of numbers in text, CSV (comma or semicolon) or separated by white space, with the place of every cell for error messages.

#include <string>
#include <string_view>
#include <vector>

#include "patina/core/error.h"

namespace patina::spectral {

struct TextCell {
    std::string text;
    int column;  // from 1
};

struct TextRow {
    int line;  // from 1
    std::vector<TextCell> cells;
};

struct TextTable {
    std::vector<std::string> comments;  // without the leading '#'
    std::vector<TextRow> rows;          // lines with at least one cell
};

// Splits text into rows and cells: at commas and semicolons where a line has one (cells may be empty), else at white space. A '#'
// starts a comment that reaches to the end of the line. Accepts any line ends and a byte order mark.
TextTable split_text_table(std::string_view text);

// The finite number in a cell. Throws Error(input) at its place in `file` for anything else.
double number_in(const TextCell& cell, const std::string& file, int line);

// The whole text as a finite number; false for anything else.
bool parse_number(std::string_view text, double& number);

// Throws Error(input) unless wavelengths[i] follows its predecessor (strictly ascending); `row` is the i-th sample's
// row.
void expect_ascending(const std::vector<double>& wavelengths, const TextRow& row, const std::string& file);

}  // namespace patina::spectral
