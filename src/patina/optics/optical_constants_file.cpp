#include "patina/optics/optical_constants_file.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/optics/dispersion_formula.h"
#include "patina/spectral/spectrum.h"
#include "patina/spectral/text_table.h"

namespace patina::optics {

namespace {

using spectral::Outside;
using spectral::SpectralFunction;
using spectral::Spectrum;
using spectral::TextCell;
using spectral::TextRow;

constexpr double nm_per_um = 1000.0;

// n or k, with the range it is given on.
struct Part {
    SpectralFunction of_nm;
    double min_nm, max_nm;
};

// One column of a table while it is read.
struct Column {
    std::vector<double> wavelengths_nm, values;

    std::optional<Part> part() const {
        if (values.empty()) return std::nullopt;
        return Part{Spectrum(wavelengths_nm, values, Outside::hold), wavelengths_nm.front(), wavelengths_nm.back()};
    }
};

double checked_n(const TextCell& cell, const std::string& file, int line) {
    const double n = spectral::number_in(cell, file, line);
    if (n > 0.0) return n;
    throw input_error({file, line, cell.column}, fmt::format("n = {}", n), "a refractive index is positive");
}

double checked_k(const TextCell& cell, const std::string& file, int line) {
    const double k = spectral::number_in(cell, file, line);
    if (k >= 0.0) return k;
    throw input_error({file, line, cell.column}, fmt::format("k = {}", k), "m = n + i k absorbs with k >= 0",
                      "write 0 for a transparent material");
}

double checked_wavelength(const TextCell& cell, const std::string& file, int line) {
    const double wavelength = spectral::number_in(cell, file, line);
    if (wavelength > 0.0) return wavelength;
    throw input_error({file, line, cell.column}, fmt::format("wavelength {}", wavelength), "wavelengths are positive");
}

// Both parts as one material, on the wavelengths where both are known.
OpticalConstants assemble(const Part& n, const std::optional<Part>& k, const std::string& file, const std::string& name,
                          const std::string& citation) {
    if (!k)
        return OpticalConstants(name, citation, n.min_nm, n.max_nm, false,
                                [n](double wavelength_nm) { return std::complex(n.of_nm(wavelength_nm), 0.0); });

    const double min_nm = std::max(n.min_nm, k->min_nm), max_nm = std::min(n.max_nm, k->max_nm);
    if (min_nm > max_nm)
        throw input_error(
            {file}, "n and k are given at no common wavelength",
            fmt::format("n from {:g} to {:g} nm, k from {:g} to {:g} nm", n.min_nm, n.max_nm, k->min_nm, k->max_nm));
    return OpticalConstants(name, citation, min_nm, max_nm, true, [n, k = *k](double wavelength_nm) {
        return std::complex(n.of_nm(wavelength_nm), k.of_nm(wavelength_nm));
    });
}

// ---- YAML -----------------------------------------------------------------------------------------------------------

SourceLocation place(const std::string& file, const YAML::Mark& mark) {
    return mark.is_null() ? SourceLocation{file} : SourceLocation{file, mark.line + 1, mark.column + 1};
}

// Citations of the database are HTML.
std::string without_markup(std::string_view html) {
    std::string text;
    bool in_tag = false, blank = true;
    for (char c : html) {
        if (c == '<') in_tag = true;
        const bool space = c == '\n' || c == '\r' || c == ' ' || c == '\t';
        if (!in_tag && !(space && blank)) text += space ? ' ' : c;
        if (!in_tag) blank = space;
        if (c == '>') in_tag = false;
    }
    while (text.ends_with(' ')) text.pop_back();
    return text;
}

class YamlPage {
  public:
    YamlPage(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

    OpticalConstantsFile read(const std::string& name) {
        try {
            return read_root(YAML::Load(text_), name);
        } catch (const YAML::Exception& error) {
            throw input_error(place(file_, error.mark), "not readable as YAML", error.msg);
        }
    }

  private:
    OpticalConstantsFile read_root(const YAML::Node& root, const std::string& name);
    void read_block(const YAML::Node& block);
    void read_formula(const YAML::Node& block, const std::string& type);
    void read_table(const YAML::Node& block, const std::string& columns);
    std::vector<TextRow> rows_of(const YAML::Node& data) const;
    std::vector<double> numbers(const YAML::Node& node, const char* key) const;
    std::string scalar(const YAML::Node& parent, const char* key) const;
    std::string optional_text(const YAML::Node& root, const char* key) const;
    void set(std::optional<Part>& part, std::optional<Part> value, const char* what, const YAML::Node& block) const;

    [[noreturn]] void fail(const YAML::Node& node, std::string_view problem, std::string_view why = {},
                           std::string_view suggestion = {}) const {
        throw input_error(place(file_, node.Mark()), problem, why, suggestion);
    }

    std::string text_, file_;
    std::optional<Part> n_, k_;
};

OpticalConstantsFile YamlPage::read_root(const YAML::Node& root, const std::string& name) {
    if (!root.IsMap()) throw input_error({file_}, "no optical constants", "expected a YAML map with a list DATA");
    const YAML::Node data = root["DATA"];
    if (!data) fail(root, "no DATA", "expected a list DATA of tables or formulas");
    if (!data.IsSequence() || data.size() == 0) fail(data, "DATA is not a list of tables or formulas");

    for (const YAML::Node& block : data) read_block(block);
    if (!n_) fail(data, "n is missing", "DATA gives only k");
    return {assemble(*n_, k_, file_, name, optional_text(root, "REFERENCES")), optional_text(root, "COMMENTS")};
}

void YamlPage::read_block(const YAML::Node& block) {
    if (!block.IsMap()) fail(block, "an entry of DATA is not a map", "expected a key `type`");
    const std::string type = scalar(block, "type");
    if (type.starts_with("tabulated ")) {
        const std::string columns = type.substr(10);
        if (columns == "nk" || columns == "n" || columns == "k") return read_table(block, columns);
    }
    if (type.starts_with("formula ")) return read_formula(block, type);
    fail(block["type"], fmt::format("unknown type \"{}\"", type.substr(0, 40)), {},
         "known: tabulated nk, tabulated n, tabulated k, formula 1 to formula 9");
}

void YamlPage::read_formula(const YAML::Node& block, const std::string& type) {
    // Which formula, on which range, with which coefficients.
    const std::string number_text = type.substr(8);
    const int number = number_text.size() == 1 ? number_text[0] - '0' : 0;
    if (number < DispersionFormula::first_number || number > DispersionFormula::last_number)
        fail(block["type"], fmt::format("unknown formula \"{}\"", number_text.substr(0, 40)), {},
             "known: formula 1 to formula 9");
    const char* range_key = block["wavelength_range"] ? "wavelength_range" : "range";
    const std::vector<double> range = numbers(block, block[range_key] ? range_key : "wavelength_range");
    if (range.size() != 2 || !(range[0] > 0.0 && range[0] < range[1]))
        fail(block[range_key], "the wavelength range is not two ascending positive wavelengths in um");
    const std::vector<double> coefficients = numbers(block, "coefficients");
    const std::string problem = DispersionFormula::count_problem(number, static_cast<int>(coefficients.size()));
    if (!problem.empty()) fail(block["coefficients"], problem);

    // A formula must give an index everywhere it claims to; a pole narrower than the probing is found when asked for.
    const SourceLocation where = place(file_, block["coefficients"].Mark());
    const auto of_nm = [formula = DispersionFormula(number, coefficients), type, where](double wavelength_nm) {
        const double n = formula(wavelength_nm / nm_per_um);
        if (n > 0.0) return n;
        throw input_error(where, fmt::format("{} gives no positive index at {:g} nm", type, wavelength_nm),
                          "inside its own wavelength range");
    };
    constexpr int probes = 500;
    for (int i = 0; i <= probes; ++i) of_nm(nm_per_um * (range[0] + (range[1] - range[0]) * i / probes));
    set(n_, Part{of_nm, range[0] * nm_per_um, range[1] * nm_per_um}, "n", block);
}

void YamlPage::read_table(const YAML::Node& block, const std::string& columns) {
    scalar(block, "data");
    const bool has_n = columns != "k", has_k = columns != "n";
    const size_t cells = columns.size() + 1;
    Column n, k;
    std::vector<double> wavelengths;
    for (const TextRow& row : rows_of(block["data"])) {
        if (row.cells.size() != cells)
            throw input_error({file_, row.line, row.cells.front().column},
                              fmt::format("{} numbers in a row of \"tabulated {}\"", row.cells.size(), columns),
                              fmt::format("expected {}: the wavelength in um, then {}", cells, columns));
        wavelengths.push_back(checked_wavelength(row.cells[0], file_, row.line));
        spectral::expect_ascending(wavelengths, row, file_);
        if (has_n) n.values.push_back(checked_n(row.cells[1], file_, row.line));
        if (has_k) k.values.push_back(checked_k(row.cells.back(), file_, row.line));
    }
    if (wavelengths.empty()) fail(block["data"], fmt::format("\"tabulated {}\" has no rows", columns));

    for (double& wavelength : wavelengths) wavelength *= nm_per_um;
    n.wavelengths_nm = k.wavelengths_nm = wavelengths;
    if (has_n) set(n_, n.part(), "n", block);
    if (has_k) set(k_, k.part(), "k", block);
}

// The rows of a block scalar with their lines and columns in the file, which YAML's parser does not keep.
std::vector<TextRow> YamlPage::rows_of(const YAML::Node& data) const {
    spectral::TextTable table = spectral::split_text_table(data.Scalar());
    const YAML::Mark mark = data.Mark();
    const std::string_view text = text_;
    size_t begin = static_cast<size_t>(std::clamp(mark.pos, 0, static_cast<int>(text.size())));
    const bool is_block = begin < text.size() && (text[begin] == '|' || text[begin] == '>');
    int line = 1;
    for (TextRow& row : table.rows) {
        if (!is_block) {
            row.line = mark.line + 1;
            for (TextCell& cell : row.cells) cell.column = mark.column + 1;
            continue;
        }
        // Walk to the row's line: the scalar's line 1 is the one below its '|'.
        for (; line <= row.line; ++line) begin = std::min(text.find('\n', begin), text.size() - 1) + 1;
        const size_t indentation = text.find_first_not_of(" \t", begin);
        const int shift = indentation == std::string_view::npos ? 0 : static_cast<int>(indentation - begin);
        const int first = row.cells.front().column;
        for (TextCell& cell : row.cells) cell.column += shift + 1 - first;
        row.line += mark.line + 1;
    }
    return std::move(table.rows);
}

std::vector<double> YamlPage::numbers(const YAML::Node& parent, const char* key) const {
    const YAML::Node node = parent[key];
    if (!node) fail(parent, fmt::format("no {}", key));
    std::vector<TextCell> cells;
    if (node.IsSequence()) {
        for (const YAML::Node& item : node) {
            if (!item.IsScalar()) fail(item, fmt::format("{} holds something that is not a number", key));
            cells.push_back({item.Scalar(), item.Mark().column + 1});
        }
    } else if (node.IsScalar()) {
        for (TextRow& row : spectral::split_text_table(node.Scalar()).rows)
            for (TextCell& cell : row.cells) cells.push_back({cell.text, node.Mark().column + cell.column});
    } else {
        fail(node, fmt::format("{} is not a list of numbers", key));
    }
    std::vector<double> result;
    for (const TextCell& cell : cells) result.push_back(spectral::number_in(cell, file_, node.Mark().line + 1));
    return result;
}

std::string YamlPage::scalar(const YAML::Node& parent, const char* key) const {
    const YAML::Node node = parent[key];
    if (!node) fail(parent, fmt::format("no {}", key));
    if (!node.IsScalar()) fail(node, fmt::format("{} is not text", key));
    return node.Scalar();
}

std::string YamlPage::optional_text(const YAML::Node& root, const char* key) const {
    const YAML::Node node = root[key];
    return node && node.IsScalar() ? without_markup(node.Scalar()) : std::string{};
}

void YamlPage::set(std::optional<Part>& part, std::optional<Part> value, const char* what,
                   const YAML::Node& block) const {
    if (part) fail(block, fmt::format("{} is given twice", what), "an earlier entry of DATA gives it too");
    part = std::move(value);
}

// ---- CSV ------------------------------------------------------------------------------------------------------------

struct CsvHeader {
    double nm_per_unit = 1.0;
    size_t wavelength = 0, n = 0, columns = 0;
    std::optional<size_t> k;
};

CsvHeader csv_header(const TextRow& row, const std::string& file) {
    CsvHeader header{.columns = row.cells.size()};
    std::optional<size_t> wavelength, n;
    for (size_t i = 0; i < row.cells.size(); ++i) {
        const std::string& name = row.cells[i].text;
        const bool known = name == "wavelength_um" || name == "wavelength_nm" || name == "n" || name == "k";
        std::optional<size_t>& column = name == "n" ? n : name == "k" ? header.k : wavelength;
        if (!known || column)
            throw input_error({file, row.line, row.cells[i].column},
                              fmt::format("{} \"{}\"", known ? "second column" : "unknown column", name.substr(0, 40)),
                              "expected a header line such as wavelength_um,n,k or wavelength_nm,n,k");
        column = i;
        if (name == "wavelength_um") header.nm_per_unit = nm_per_um;
    }
    if (!wavelength || !n)
        throw input_error({file, row.line}, fmt::format("no column {}", wavelength ? "n" : "wavelength_um"),
                          "expected a header line such as wavelength_um,n,k or wavelength_nm,n,k");
    header.wavelength = *wavelength;
    header.n = *n;
    return header;
}

std::string csv_comment(const spectral::TextTable& table, std::string_view key) {
    for (const std::string& comment : table.comments)
        if (comment.starts_with(key)) return without_markup(std::string_view(comment).substr(key.size()));
    return {};
}

}  // namespace

OpticalConstantsFile parse_optical_constants_yaml(std::string_view text, const std::string& file,
                                                  const std::string& name) {
    return YamlPage(text, file).read(name);
}

OpticalConstantsFile parse_optical_constants_csv(std::string_view text, const std::string& file,
                                                 const std::string& name) {
    const spectral::TextTable table = spectral::split_text_table(text);
    if (table.rows.empty())
        throw input_error({file}, "no optical constants", "expected a header line such as wavelength_um,n,k");
    const CsvHeader header = csv_header(table.rows[0], file);

    Column n, k;
    std::vector<double> wavelengths;
    for (size_t i = 1; i < table.rows.size(); ++i) {
        const TextRow& row = table.rows[i];
        if (row.cells.size() != header.columns)
            throw input_error({file, row.line}, fmt::format("{} cells in a row", row.cells.size()),
                              fmt::format("the header names {}", header.columns));
        wavelengths.push_back(checked_wavelength(row.cells[header.wavelength], file, row.line));
        spectral::expect_ascending(wavelengths, row, file);
        n.wavelengths_nm.push_back(wavelengths.back() * header.nm_per_unit);
        n.values.push_back(checked_n(row.cells[header.n], file, row.line));
        if (!header.k || row.cells[*header.k].text.empty()) continue;
        k.wavelengths_nm.push_back(n.wavelengths_nm.back());
        k.values.push_back(checked_k(row.cells[*header.k], file, row.line));
    }
    if (n.values.empty()) throw input_error({file}, "no rows below the header");
    return {assemble(*n.part(), k.part(), file, name, csv_comment(table, "publication:")),
            csv_comment(table, "comments:")};
}

OpticalConstantsFile read_optical_constants(const std::filesystem::path& path) {
    constexpr std::uint64_t largest_bytes = 16u << 20;
    const std::string extension = path.extension().string(), name = path.stem().string(), file = path.string();
    const bool yaml = extension == ".yml" || extension == ".yaml";
    if (!yaml && extension != ".csv")
        throw input_error({file}, fmt::format("unknown kind of optical constants \"{}\"", extension), {},
                          "known: .yml, .yaml (refractiveindex.info), .csv");
    const std::string text = read_text_file(path, largest_bytes);
    return yaml ? parse_optical_constants_yaml(text, file, name) : parse_optical_constants_csv(text, file, name);
}

}  // namespace patina::optics
