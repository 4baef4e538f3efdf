#include "patina/io/located_text.h"

#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace patina::io {

namespace {

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

// from_chars knows no leading plus, which people write in exponents' company.
std::string_view without_plus(std::string_view text) {
    const bool signed_number = text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+';
    return signed_number ? text.substr(1) : text;
}

template <class Number>
std::errc convert(std::string_view text, Number& number) {
    const std::string_view body = without_plus(trimmed(text));
    const auto [end, error] = std::from_chars(body.data(), body.data() + body.size(), number);
    if (error != std::errc{}) return error;
    return end == body.data() + body.size() && !body.empty() ? std::errc{} : std::errc::invalid_argument;
}

}  // namespace

std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 60;
    std::string shown;
    for (const char c : text.substr(0, longest)) shown += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    if (text.size() > longest) shown += fmt::format("... ({} characters)", text.size());
    return fmt::format("\"{}\"", shown);
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

std::vector<std::string_view> split_list(std::string_view text) {
    std::vector<std::string_view> pieces;
    std::size_t at = 0;
    const auto skip_spaces = [&] {
        while (at < text.size() && is_space(text[at])) ++at;
    };
    skip_spaces();
    bool expect_piece = at < text.size();
    while (expect_piece) {
        const std::size_t begin = at;
        while (at < text.size() && !is_space(text[at]) && text[at] != ',') ++at;
        pieces.push_back(text.substr(begin, at - begin));

        // A comma promises another piece, white space alone does not.
        skip_spaces();
        const bool comma = at < text.size() && text[at] == ',';
        if (comma) ++at;
        skip_spaces();
        expect_piece = comma || at < text.size();
    }
    return pieces;
}

double parse_float(std::string_view text, const SourceLocation& where, std::string_view what) {
    double number = 0;
    const std::errc error = convert(text, number);
    if (error == std::errc::result_out_of_range)
        throw input_error(where, fmt::format("{} {} is out of range", what, in_quotes(text)),
                          "numbers are 64-bit floating point");
    if (error != std::errc{})
        throw input_error(where, fmt::format("{} {} is not a number", what, in_quotes(text)), "",
                          "write it like 0.25 or 2.5e-1");
    if (!std::isfinite(number))
        throw input_error(where, fmt::format("{} {} is not a finite number", what, in_quotes(text)));
    return number;
}

std::int64_t parse_integer(std::string_view text, const SourceLocation& where, std::string_view what) {
    std::int64_t number = 0;
    const std::errc error = convert(text, number);
    if (error == std::errc::result_out_of_range)
        throw input_error(where, fmt::format("{} {} is out of range", what, in_quotes(text)), "integers have 64 bits");
    if (error != std::errc{}) throw input_error(where, fmt::format("{} {} is not an integer", what, in_quotes(text)));
    return number;
}

bool parse_boolean(std::string_view text, const SourceLocation& where) {
    std::string word(trimmed(text));
    // Python writes True, and Mitsuba does not mind.
    for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (word == "true") return true;
    if (word == "false") return false;
    throw input_error(where, fmt::format("value {} is not a boolean", in_quotes(text)), "", "write true or false");
}

std::vector<double> parse_floats(std::string_view text, const SourceLocation& where, std::size_t count) {
    const std::vector<std::string_view> pieces = split_list(text);
    if (pieces.empty()) throw input_error(where, "the value is empty", "numbers are expected");
    if (count != 0 && pieces.size() != count)
        throw input_error(where, fmt::format("{} has {} numbers", in_quotes(text), pieces.size()),
                          fmt::format("{} are expected", count));
    std::vector<double> numbers;
    numbers.reserve(pieces.size());
    for (const std::string_view piece : pieces) numbers.push_back(parse_float(piece, where, "number"));
    return numbers;
}

}  // namespace patina::io
