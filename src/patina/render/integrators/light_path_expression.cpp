#include "patina/render/integrators/light_path_expression.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include <fmt/format.h>

#include "patina/core/error.h"

namespace patina::render {

namespace {

constexpr std::size_t longest_expression = 500;  // symbols: the automaton of any sensible expression stays small
constexpr std::size_t most_states = 20'000;

using Positions = std::set<int>;

struct Position {
    char symbol;  // L, E, D, G, S, V or .
    int column;
    Positions followers;
};

// What a part of an expression can begin and end with, and whether it may be empty.
struct Part {
    bool nullable = false;
    Positions first, last;
};

// A window of a text and a caret under one of its places.
std::string pointed_at(std::string_view text, std::size_t index) {
    constexpr std::size_t margin = 30;
    const std::size_t begin = index > margin ? index - margin : 0;
    std::string shown(text.substr(begin, 2 * margin));
    for (char& c : shown)
        if (std::isprint(static_cast<unsigned char>(c)) == 0) c = '?';
    const std::string_view before = begin > 0 ? "..." : "", after = begin + shown.size() < text.size() ? "..." : "";
    return fmt::format("    {}{}{}\n    {:>{}}", before, shown, after, '^', before.size() + index - begin + 1);
}

class Parser {
  public:
    Parser(const LightPathExpression& expression, std::vector<Position>& positions)
        : expression_(expression), text_(expression.text), positions_(positions) {}

    Part parse() {
        if (text_.size() > longest_expression)
            fail(longest_expression, fmt::format("longer than {} characters", longest_expression));
        Part whole = alternatives();
        if (at_ < text_.size()) fail(at_, fmt::format("\"{}\" closes nothing", text_[at_]));
        return whole;
    }
    [[noreturn]] void fail(std::size_t index, const std::string& problem) const {
        throw Error(ErrorKind::usage, fmt::format("light-path expression {}, column {}: {}\n{}", expression_.name,
                                                  index + 1, problem, pointed_at(text_, index)));
    }

  private:
    char peek() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    std::string unexpected() const {
        return fmt::format("\"{}\" is no symbol; write L, E, D, G, S, V, . ( ) [ ] | * + ?", text_[at_]);
    }

    Part alternatives() {
        Part all = sequence();
        while (peek() == '|') {
            ++at_;
            const Part other = sequence();
            all.nullable |= other.nullable;
            all.first.insert(other.first.begin(), other.first.end());
            all.last.insert(other.last.begin(), other.last.end());
        }
        return all;
    }

    Part sequence() {
        Part all = repeated();
        while (peek() != '\0' && peek() != '|' && peek() != ')' && peek() != ']') {
            const Part next = repeated();
            link(all.last, next.first);
            if (all.nullable) all.first.insert(next.first.begin(), next.first.end());
            if (next.nullable)
                all.last.insert(next.last.begin(), next.last.end());
            else
                all.last = next.last;
            all.nullable &= next.nullable;
        }
        return all;
    }

    Part repeated() {
        Part part = single();
        for (char c = peek(); c == '*' || c == '+' || c == '?'; c = peek()) {
            ++at_;
            if (c != '?') link(part.last, part.first);
            part.nullable |= c != '+';
        }
        return part;
    }

    Part single() {
        const char c = peek();
        if (c == '(' || c == '[') {
            const std::size_t opening = at_++;
            Part inner = alternatives();
            if (peek() != (c == '(' ? ')' : ']')) fail(opening, fmt::format("\"{}\" is not closed", c));
            ++at_;
            return inner;
        }
        if (c == '\0') fail(at_, "a symbol is missing at the end");
        if (c == '|' || c == ')' || c == ']' || c == '*' || c == '+' || c == '?')
            fail(at_, fmt::format("a symbol is missing before \"{}\"", c));
        if (std::string_view("LEDGSV.").find(c) == std::string_view::npos) fail(at_, unexpected());
        const int position = static_cast<int>(positions_.size());
        positions_.push_back({c, static_cast<int>(at_++), {}});
        return {false, {position}, {position}};
    }

    void link(const Positions& from, const Positions& to) {
        for (int position : from) positions_[position].followers.insert(to.begin(), to.end());
    }

    const LightPathExpression& expression_;
    const std::string& text_;
    std::vector<Position>& positions_;
    std::size_t at_ = 0;
};

// Parses one expression into positions [begin, end) that read from the eye to the light; returns the eyes.
Positions append_expression(const LightPathExpression& expression, std::vector<Position>& positions) {
    const int begin = static_cast<int>(positions.size());
    Parser parser(expression, positions);
    Part whole = parser.parse();
    const auto column = [&](int position) { return static_cast<std::size_t>(positions[position].column); };

    // Turn what is written from the light around.
    if (positions[*whole.first.begin()].symbol == 'L') {
        std::vector<Positions> reversed(positions.size());
        for (int p = begin; p < static_cast<int>(positions.size()); ++p)
            for (int follower : positions[p].followers) reversed[follower].insert(p);
        for (int p = begin; p < static_cast<int>(positions.size()); ++p) positions[p].followers = reversed[p];
        std::swap(whole.first, whole.last);
    }

    // Expect the eye at one end, the light at the other, and neither between.
    for (int p = begin; p < static_cast<int>(positions.size()); ++p) {
        const char symbol = positions[p].symbol;
        if (whole.first.contains(p) != (symbol == 'E') || whole.last.contains(p) != (symbol == 'L'))
            parser.fail(column(p), "a path goes from L to E, or from E to L, with D, G, S, V and . between");
        if (symbol == 'L' && !positions[p].followers.empty())
            parser.fail(column(p), "L can stand at an end of the path only");
        for (int follower : positions[p].followers)
            if (positions[follower].symbol == 'E')
                parser.fail(column(follower), "E can stand at an end of the path only");
    }
    return whole.first;
}

bool reads(char symbol, ScatteringEvent event) {
    switch (symbol) {
        case '.':
            return true;
        case 'D':
            return event == ScatteringEvent::diffuse;
        case 'G':
            return event == ScatteringEvent::glossy;
        case 'S':
            return event == ScatteringEvent::specular;
        case 'V':
            return event == ScatteringEvent::volume;
        default:
            return false;
    }
}

}  // namespace

LightPathClassifier::LightPathClassifier(std::span<const LightPathExpression> expressions) {
    std::vector<Position> positions;
    std::vector<int> expression_of;
    Positions start;
    for (int e = 0; e < static_cast<int>(expressions.size()); ++e) {
        start.merge(append_expression(expressions[e], positions));
        expression_of.resize(positions.size(), e);
    }

    // Explore the sets of positions the automaton can be in.
    std::map<Positions, int> number_of{{start, eye}};
    std::map<std::vector<bool>, int> class_of;
    std::vector<Positions> sets{start};
    for (std::size_t s = 0; s < sets.size(); ++s) {
        const Positions current = sets[s];
        State state;
        std::vector<bool> accepted(expressions.size(), false);
        for (int p : current)
            for (int follower : positions[p].followers)
                if (positions[follower].symbol == 'L') accepted[expression_of[follower]] = true;
        state.path_class = class_of.try_emplace(accepted, static_cast<int>(class_of.size())).first->second;
        if (state.path_class == static_cast<int>(members_.size())) members_.push_back(accepted);
        for (int event = 0; event < scattering_events; ++event) {
            Positions next;
            for (int p : current)
                for (int follower : positions[p].followers)
                    if (reads(positions[follower].symbol, static_cast<ScatteringEvent>(event))) next.insert(follower);
            const auto [place, is_new] = number_of.try_emplace(next, static_cast<int>(sets.size()));
            if (is_new) sets.push_back(next);
            state.next[event] = place->second;
        }
        states_.push_back(state);
        if (sets.size() > most_states)
            throw Error(ErrorKind::usage, "the light-path expressions are too complex together: ask for fewer at once");
    }
}

}  // namespace patina::render
