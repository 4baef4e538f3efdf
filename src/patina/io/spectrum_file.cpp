#include "patina/io/spectrum_file.h"

#include <cctype>
#include <string>

#include <fmt/format.h>

#include "patina/core/files.h"
#include "patina/io/located_text.h"

namespace patina::io {

namespace {

constexpr std::uint64_t largest_spectrum_bytes = std::uint64_t{64} << 20;

bool is_header(std::string_view line) {
    return !line.empty() && std::isalpha(static_cast<unsigned char>(line[0]));
}

}  // namespace

void expect_sampled(const SpectrumSpec& spectrum, const SourceLocation& where) {
    const auto& wavelengths = spectrum.wavelengths_nm;
    if (wavelengths.empty()) throw input_error(where, "the spectrum has no sample");
    if (wavelengths.size() != spectrum.values.size())
        throw input_error(where, fmt::format("the spectrum has {} wavelengths and {} values", wavelengths.size(),
                                             spectrum.values.size()));
    if (wavelengths.front() <= 0)
        throw input_error(where, fmt::format("wavelength {} nm is not positive", wavelengths.front()));
    for (std::size_t i = 1; i < wavelengths.size(); ++i) {
        if (wavelengths[i] > wavelengths[i - 1]) continue;
        throw input_error(where, fmt::format("wavelength {} nm follows {} nm", wavelengths[i], wavelengths[i - 1]),
                          "they must ascend");
    }
}

SpectrumSpec read_spectrum_file(const std::filesystem::path& path) {
    const std::string text = read_text_file(path, largest_spectrum_bytes);
    SpectrumSpec spectrum;
    spectrum.kind = SpectrumSpec::Kind::sampled;
    SourceLocation where{path.string(), 0, 0};
    bool header_allowed = true;
    for (std::size_t begin = 0; begin < text.size();) {
        // Take one line without its comment.
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string line = text.substr(begin, end - begin);
        begin = end + 1;
        ++where.line;
        line = std::string(trimmed(std::string_view(line).substr(0, line.find('#'))));
        if (line.empty()) continue;
        if (header_allowed && is_header(line)) {
            header_allowed = false;
            continue;
        }
        header_allowed = false;

        // Read its two numbers.
        for (char& c : line)
            if (c == ';') c = ',';
        const std::vector<double> pair = parse_floats(line, where, 2);
        spectrum.wavelengths_nm.push_back(pair[0]);
        spectrum.values.push_back(pair[1]);
        if (spectrum.wavelengths_nm.size() > 1) {
            const double previous = spectrum.wavelengths_nm[spectrum.wavelengths_nm.size() - 2];
            if (pair[0] <= previous)
                throw input_error(where, fmt::format("wavelength {} nm follows {} nm", pair[0], previous),
                                  "they must ascend");
        }
    }
    expect_sampled(spectrum, {path.string()});
    return spectrum;
}

}  // namespace patina::io
