#include <charconv>

#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"

namespace patina::cli {

namespace {

Error bad_list(std::string_view text, std::string_view option) {
    return Error(ErrorKind::usage,
                 fmt::format("{}: \"{}\" is not a list of numbers (write 0,30,60 or 380:780:5)", option, text));
}

double parse_number(std::string_view text, std::string_view whole, std::string_view option) {
    double value = 0.0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc{} || end != text.data() + text.size() || std::isnan(value)) throw bad_list(whole, option);
    return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    while (true) {
        const size_t at = text.find(separator);
        parts.push_back(text.substr(0, at));
        if (at == std::string_view::npos) return parts;
        text.remove_prefix(at + 1);
    }
}

}  // namespace

std::vector<double> parse_number_list(const std::string& text, std::string_view option) {
    constexpr double most_values = 1e6;
    std::vector<double> values;
    for (const std::string_view item : split(text, ',')) {
        const std::vector<std::string_view> parts = split(item, ':');
        if (parts.size() == 1) {
            values.push_back(parse_number(parts[0], text, option));
            continue;
        }
        if (parts.size() != 3) throw bad_list(text, option);
        const double begin = parse_number(parts[0], text, option);
        const double end = parse_number(parts[1], text, option);
        const double step = parse_number(parts[2], text, option);
        const double count = std::floor((end - begin) / step + 1e-9) + 1;
        if (!(count >= 1 && count <= most_values) || !std::isfinite(begin)) throw bad_list(text, option);
        for (int i = 0; i < static_cast<int>(count); ++i) values.push_back(begin + i * step);
    }
    return values;
}

}  // namespace patina::cli
