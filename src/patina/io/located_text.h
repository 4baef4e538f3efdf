#pragma once
// Text of a user's file with the place it came from, and the strict reading of numbers out of it.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "patina/core/error.h"

namespace patina::io {

struct LocatedText {
    std::string text;
    SourceLocation where;
};

// `"text"`, cut to a length a person reads, for messages.
std::string in_quotes(std::string_view text);

// Without the white space at both ends.
std::string_view trimmed(std::string_view text);

// The pieces between commas and white space ("a, b c" is three); two commas in a row make an empty piece.
std::vector<std::string_view> split_list(std::string_view text);

// A finite number and nothing else. Throws Error(input) at `where`; `what` names the value in the message.
double parse_float(std::string_view text, const SourceLocation& where, std::string_view what = "value");
std::int64_t parse_integer(std::string_view text, const SourceLocation& where, std::string_view what = "value");

// "true" or "false".
bool parse_boolean(std::string_view text, const SourceLocation& where);

// Finite numbers between commas and white space; `count` 0 takes any number of them above zero.
std::vector<double> parse_floats(std::string_view text, const SourceLocation& where, std::size_t count = 0);

}  // namespace patina::io
