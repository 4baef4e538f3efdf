#include "patina/spectral/spectrum_file.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/spectral/text_table.h"

namespace patina::spectral {

namespace {

// nm per unit of the first column when the row is a header, 0 when it holds numbers.
double header_unit(const TextRow& row, const std::string& file) {
    double number = 0.0;
    const std::string& first = row.cells[0].text;
    if (parse_number(first, number)) return 0.0;
    if (first == "wavelength_nm") return 1.0;
    if (first == "wavelength_um") return 1000.0;
    throw input_error({file, row.line, row.cells[0].column},
                      fmt::format("\"{}\" is no wavelength", first.substr(0, 40)),
                      "expected a number in nm, or a header line that starts with wavelength_nm or wavelength_um");
}

}  // namespace

Spectrum parse_spectrum(std::string_view text, const std::string& file, Outside outside) {
    const TextTable table = split_text_table(text);
    if (table.rows.empty()) throw input_error({file}, "no spectrum", "expected rows of wavelength in nm and value");
    const double unit = header_unit(table.rows[0], file);

    std::vector<double> wavelengths, values;
    for (size_t i = unit > 0.0 ? 1 : 0; i < table.rows.size(); ++i) {
        const TextRow& row = table.rows[i];
        if (row.cells.size() != 2)
            throw input_error({file, row.line, row.cells[0].column}, fmt::format("{} cells in a row", row.cells.size()),
                              "expected 2: wavelength and value");
        wavelengths.push_back(number_in(row.cells[0], file, row.line));
        if (wavelengths.back() <= 0.0)
            throw input_error({file, row.line, row.cells[0].column}, fmt::format("wavelength {}", wavelengths.back()),
                              "wavelengths are positive");
        expect_ascending(wavelengths, row, file);
        values.push_back(number_in(row.cells[1], file, row.line));
    }
    if (values.empty()) throw input_error({file}, "no rows below the header");
    if (unit > 0.0)
        for (double& wavelength : wavelengths) wavelength *= unit;
    return Spectrum(std::move(wavelengths), std::move(values), outside);
}

Spectrum read_spectrum(const std::filesystem::path& path, Outside outside) {
    constexpr std::uint64_t largest_bytes = 16u << 20;
    return parse_spectrum(read_text_file(path, largest_bytes), path.string(), outside);
}

}  // namespace patina::spectral
