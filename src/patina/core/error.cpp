#include "patina/core/error.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace patina {

namespace {

// Levenshtein's edit distance, one row at a time.
size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
        }
    }
    return row.back();
}

// What a message keeps of a part: a user's word may be a million characters long.
std::string shortened(std::string_view part) {
    constexpr size_t longest = 1500, head = 300, tail = 100;
    if (part.size() <= longest) return std::string(part);
    // Characters of UTF-8 are not cut in two.
    const auto continues = [&](size_t i) { return (static_cast<unsigned char>(part[i]) & 0xc0) == 0x80; };
    size_t first = head, last = part.size() - tail;
    while (first > 0 && continues(first)) --first;
    while (last < part.size() && continues(last)) ++last;
    return fmt::format("{} [... {} characters ...] {}", part.substr(0, first), last - first, part.substr(last));
}

std::string compose(std::string_view where, std::string_view problem, std::string_view why,
                    std::string_view suggestion) {
    std::string message;
    if (!where.empty()) message += fmt::format("{}: ", where);
    message += shortened(problem);
    if (!why.empty()) message += fmt::format(" ({})", shortened(why));
    if (!suggestion.empty()) message += fmt::format("; {}", shortened(suggestion));
    return message;
}

}  // namespace

std::string SourceLocation::to_string() const {
    std::string text = file;
    if (line > 0) text += fmt::format(":{}", line);
    if (line > 0 && column > 0) text += fmt::format(":{}", column);
    return text;
}

Error input_error(const SourceLocation& where, std::string_view problem, std::string_view why,
                  std::string_view suggestion) {
    return Error(ErrorKind::input, compose(where.to_string(), problem, why, suggestion));
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates, bool list_all) {
    // Words of the user can be a million characters long; a distance to those means nothing.
    constexpr size_t longest_word = 64;
    if (candidates.empty()) return {};
    if (word.size() <= longest_word) {
        const auto nearest = std::min_element(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
            return edit_distance(word, a) < edit_distance(word, b);
        });
        const size_t acceptable = std::max<size_t>(2, word.size() / 3);
        if (edit_distance(word, *nearest) <= acceptable) return fmt::format("did you mean \"{}\"?", *nearest);

        // "CaCO3-calcite" for "CaCO3", "rough" for "roughconductor": the one begins with the other.
        constexpr size_t shortest_beginning = 3;
        for (const std::string& candidate : candidates)
            if (std::min(word.size(), candidate.size()) >= shortest_beginning &&
                (word.starts_with(candidate) || candidate.starts_with(word)))
                return fmt::format("did you mean \"{}\"?", candidate);
    }
    return list_all ? fmt::format("known: {}", fmt::join(candidates, ", ")) : std::string{};
}

}  // namespace patina
