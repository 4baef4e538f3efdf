#include <charconv>
#include <sstream>

#include <fmt/format.h>

#include "patina/coating/recipe.h"
#include "patina/core/files.h"

namespace patina::coating {

namespace {

constexpr std::string_view header = "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2";
constexpr int largest_order = 20000;

std::string without_blanks(std::string_view line) {
    std::string text;
    for (const char c : line)
        if (c != ' ' && c != '\t' && c != '\r') text += c;
    return text;
}

// The seven numbers of a row; errors name the column.
std::array<double, 7> parse_row(const std::string& line, const SourceLocation& where) {
    std::array<double, 7> row{};
    const char* at = line.data();
    const char* const end = line.data() + line.size();
    for (size_t column = 0; column < row.size(); ++column) {
        const SourceLocation here{where.file, where.line, static_cast<int>(at - line.data()) + 1};
        const auto [stop, status] = std::from_chars(at, end, row[column]);
        if (status != std::errc{} || !std::isfinite(row[column]))
            throw input_error(here, "a finite number is expected", fmt::format("the columns are {}", header));
        const bool last = column + 1 == row.size();
        if (last ? stop != end : (stop == end || *stop != ','))
            throw input_error(here, "a row has seven numbers separated by commas",
                              fmt::format("the columns are {}", header));
        at = stop + 1;
    }
    return row;
}

}  // namespace

optics::ExpansionCoefficients read_expansion_csv(const std::filesystem::path& path) {
    std::istringstream stream(read_text_file(path, std::uint64_t{64} << 20));
    optics::ExpansionCoefficients c;
    bool header_seen = false;
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        const SourceLocation where{path.string(), number, 1};
        line = without_blanks(line);
        if (line.empty() || line.front() == '#') continue;
        if (!header_seen) {
            if (line != header)
                throw input_error(where, "the header line is missing", fmt::format("it reads {}", header));
            header_seen = true;
            continue;
        }
        const std::array<double, 7> row = parse_row(line, where);
        const int expected = static_cast<int>(c.alpha1.size());
        if (row[0] != expected)
            throw input_error(where, fmt::format("l = {:g} where l = {} is expected", row[0], expected),
                              "orders count up from 0");
        if (expected > largest_order) throw input_error(where, fmt::format("more than {} orders", largest_order));
        std::vector<double>* columns[] = {&c.alpha1, &c.alpha2, &c.alpha3, &c.alpha4, &c.beta1, &c.beta2};
        for (size_t i = 0; i < std::size(columns); ++i) columns[i]->push_back(row[i + 1]);
    }
    if (c.alpha1.empty())
        throw input_error({path.string()}, "no coefficients",
                          fmt::format("expected the header {} and a row an order", header));
    if (std::abs(c.alpha1[0] - 1.0) > 1e-6)
        throw input_error({path.string()}, fmt::format("alpha1 of l = 0 is {:g}", c.alpha1[0]),
                          "the scattering matrix is normalised so that it is 1");
    for (size_t l = 0; l < c.alpha1.size(); ++l)
        if (std::abs(c.alpha1[l]) > (2.0 * static_cast<double>(l) + 1.0) * (1 + 1e-6))
            throw input_error(
                {path.string()}, fmt::format("alpha1 of l = {} is {:g}", l, c.alpha1[l]),
                fmt::format("a phase function that is nowhere negative has at most 2l+1 = {}", 2 * l + 1));
    return c;
}

}  // namespace patina::coating
