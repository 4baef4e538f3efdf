#pragma once
// Wrong inputs made of right ones, the same ones for the same seed.

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace patina::fuzz {

class Mutator {
  public:
    explicit Mutator(unsigned seed) : random_(seed) {}

    // One to four changes of a text.
    std::string text(std::string value) {
        for (int left = 1 + below(4); left > 0; --left) value = change_text(std::move(value));
        return value;
    }

    // One to eight changes of a binary file; most are near its head, where sizes and offsets stand.
    std::string binary(std::string bytes) {
        for (int left = 1 + below(8); left > 0; --left) change_bytes(bytes);
        return bytes;
    }

  private:
    int below(std::size_t end) { return end == 0 ? 0 : static_cast<int>(random_() % end); }
    std::size_t place(const std::string& value) { return static_cast<std::size_t>(below(value.size() + 1)); }
    template <class List>
    const auto& any(const List& list) {
        return list[static_cast<std::size_t>(below(std::size(list)))];
    }

    // Where pieces of a text begin and end: words and numbers, or what stands between them.
    struct Token {
        std::size_t begin, end;
    };
    static std::vector<Token> tokens(const std::string& value) {
        static const auto in_word = [](char c) {
            return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-' || c == '+';
        };
        std::vector<Token> result;
        for (std::size_t i = 0; i < value.size();) {
            const std::size_t begin = i;
            while (i < value.size() && in_word(value[i]) == in_word(value[begin])) ++i;
            result.push_back({begin, i});
        }
        return result;
    }
    static std::string piece(const std::string& value, const Token& token) {
        return value.substr(token.begin, token.end - token.begin);
    }

    std::string change_text(std::string value) {
        if (value.empty()) return std::string(1, static_cast<char>(random_()));
        const std::vector<Token> all = tokens(value);
        const Token here = any(all), there = any(all);
        switch (below(14)) {
            case 0:  // flip bits of a byte
                value[static_cast<std::size_t>(below(value.size()))] ^= static_cast<char>(1 + below(255));
                return value;
            case 1:  // one token in place of another
                return value.replace(here.begin, here.end - here.begin, piece(value, there));
            case 2:  // numbers become numbers no one meant
                return with_number(std::move(value), all);
            case 3:  // cut the end off
                return value.substr(0, place(value));
            case 4: {  // nest deeply
                static const char* const pairs[] = {"[", "{a=", "[[", "(", "- ", "a: ", "\"", "{", "&a [*a, "};
                const std::string open = any(pairs);
                std::string nest;
                for (int left = 1 << below(15); left > 0; --left) nest += open;
                return value.insert(here.begin, nest);
            }
            case 5: {  // values of another type
                static const char* const others[] = {
                    "true",  "\"x\"", "[1, 2]", "{ a = 1 }", "1979-05-27",         "[]",
                    "{}",    "''",    "null",   "~",         "0x7fffffffffffffff", "1_000",
                    "+.inf", ".nan",  "\"\"\"", "!!binary x"};
                return value.replace(here.begin, here.end - here.begin, any(others));
            }
            case 6: {  // lines twice
                const std::size_t begin = value.rfind('\n', here.begin) + 1;
                const std::size_t end = std::min(value.find('\n', here.begin), value.size() - 1) + 1;
                return value.insert(begin, value.substr(begin, end - begin));
            }
            case 7: {  // garbage
                std::string garbage;
                for (int left = 1 + below(40); left > 0; --left) garbage += static_cast<char>(random_());
                return value.insert(place(value), garbage);
            }
            case 8:  // a very long word
                return value.insert(place(value), std::string(below(20) == 0 ? 1'000'000 : 5000, any("x9 ,#\n")));
            case 9:  // leave a token out
                return value.erase(here.begin, here.end - here.begin);
            case 10: {  // leave a line out
                const std::size_t begin = value.rfind('\n', here.begin) + 1;
                const std::size_t end = std::min(value.find('\n', here.begin), value.size() - 1) + 1;
                return value.erase(begin, end - begin);
            }
            case 11:  // swap two places
                return value.substr(0, std::min(here.begin, there.begin)) +
                       value.substr(std::max(here.begin, there.begin)) + piece(value, here);
            case 12:  // bytes that end strings early, or start what is not UTF-8
                return value.insert(place(value),
                                    any(std::vector<std::string>{std::string(1, '\0'), "\xff", "\xed\xa0\x80",
                                                                 "\xef\xbb\xbf", "\r", "\xf4\x90\x80\x80"}));
            default:  // the whole twice
                return value.size() < 200'000 ? value + value : value;
        }
    }

    std::string with_number(std::string value, const std::vector<Token>& all) {
        static const char* const numbers[] = {"nan",
                                              "inf",
                                              "-inf",
                                              "-1",
                                              "0",
                                              "-0.0",
                                              "1e308",
                                              "1e-308",
                                              "1e999",
                                              "-1e999",
                                              "99999999999999999999",
                                              "0.5",
                                              "2",
                                              "1e9",
                                              "-1e-30",
                                              "4.9e-324",
                                              "1e-5",
                                              "73",
                                              "1.",
                                              ".5",
                                              "0x1p3",
                                              "1e",
                                              "--1"};
        std::vector<Token> found;
        for (const Token& token : all)
            if (std::isdigit(static_cast<unsigned char>(value[token.begin])) || value[token.begin] == '-')
                found.push_back(token);
        if (found.empty()) return value;
        const Token token = any(found);
        return value.replace(token.begin, token.end - token.begin, any(numbers));
    }

    void change_bytes(std::string& bytes) {
        if (bytes.empty()) return;
        const std::size_t reach = below(3) == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 512);
        const std::size_t at = static_cast<std::size_t>(below(reach));
        switch (below(6)) {
            case 0:
                bytes[at] ^= static_cast<char>(1 << below(8));
                return;
            case 1:
                bytes[at] = static_cast<char>(random_());
                return;
            case 2: {  // eight bytes that are a huge, a negative or no number
                static const std::uint64_t words[] = {
                    0, ~0ull, 1ull << 63, 1ull << 32, 0x7ff0000000000000ull, 0x7ff8000000000000ull, 0x7fffffffull};
                const std::uint64_t word = any(words);
                for (std::size_t k = 0; k < 8 && at + k < bytes.size(); ++k)
                    bytes[at + k] = static_cast<char>(word >> (8 * k));
                return;
            }
            case 3:
                if (below(4) == 0) bytes.resize(static_cast<std::size_t>(below(bytes.size())));
                return;
            case 4:
                bytes.insert(at, std::string(1 + static_cast<std::size_t>(below(16)), static_cast<char>(random_())));
                return;
            default:
                bytes.erase(at, 1 + static_cast<std::size_t>(below(16)));
                return;
        }
    }

    std::mt19937 random_;
};

}  // namespace patina::fuzz
