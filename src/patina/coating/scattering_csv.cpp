#include "patina/coating/scattering_csv.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "patina/coating/number_csv.h"
#include "patina/optics/scattering/expansion.h"
#include "patina/optics/scattering/tabulated_matrix.h"

namespace patina::coating {

namespace {

constexpr int largest_order = 20000;
// Below what tables of scattering matrices are good for.
constexpr double matrix_tolerance = 1e-7;
// A forward peak cut off swings to -0.13 of its height (the least of 2 J1(x)/x); what goes further down is no series of
// a scattering matrix at all.
constexpr double deepest_swing = 0.25;

constexpr std::array<std::string_view, 2> expansion_headers{"l,alpha1,alpha2,alpha3,alpha4,beta1,beta2",
                                                            "wavelength_nm,l,alpha1,alpha2,alpha3,alpha4,beta1,beta2"};
constexpr std::array<std::string_view, 2> matrix_headers{"angle_deg,F11,F12,F22,F33,F34,F44",
                                                         "wavelength_nm,angle_deg,F11,F12,F22,F33,F34,F44"};
constexpr std::array<std::string_view, 1> cross_section_headers{"wavelength_nm,extinction_um2,scattering_um2"};

void expect_next_wavelength(double wavelength_nm, double previous_nm, const SourceLocation& where) {
    if (wavelength_nm <= 0.0) throw input_error(where, fmt::format("a wavelength of {:g} nm", wavelength_nm));
    if (wavelength_nm <= previous_nm)
        throw input_error(where, fmt::format("wavelength {:g} nm follows {:g} nm", wavelength_nm, previous_nm),
                          "they ascend", "sort the file");
}

// The rows of one wavelength, without it.
struct Block {
    double wavelength_nm = 0.0;  // 0 in a file without wavelengths
    std::vector<NumberRow> rows;
};

std::vector<Block> blocks_of(NumberTable table, const std::filesystem::path& path) {
    if (table.rows.empty())
        throw input_error({path.string()}, "no coefficients and no angles",
                          "expected a header and a row an order or an angle");
    if (!table.header.starts_with("wavelength_nm")) return {{0.0, std::move(table.rows)}};
    std::vector<Block> blocks;
    for (NumberRow& row : table.rows) {
        const double wavelength = row.values.front();
        if (blocks.empty() || wavelength != blocks.back().wavelength_nm) {
            expect_next_wavelength(wavelength, blocks.empty() ? 0.0 : blocks.back().wavelength_nm, row.where);
            blocks.push_back({wavelength, {}});
        }
        row.values.erase(row.values.begin());
        blocks.back().rows.push_back(std::move(row));
    }
    return blocks;
}

// Columns in another order or of other definitions show in what the matrix would do to light.
void expect_possible(const optics::ExpansionCoefficients& c, const SourceLocation& where) {
    const optics::StokesCriterion found = optics::stokes_criterion(c);
    if (found.excess > deepest_swing * found.largest_a1)
        throw input_error(
            where,
            fmt::format(
                "scattered by {:.0f} degrees light would have more polarization than intensity, or less than no "
                "intensity",
                found.angle_deg),
            fmt::format("by {:.2g}, where a1 is 1 on average", found.excess),
            "check the order and the definitions of the columns");
}

optics::ExpansionCoefficients coefficients_of(const Block& block) {
    optics::ExpansionCoefficients c;
    std::vector<double>* const columns[] = {&c.alpha1, &c.alpha2, &c.alpha3, &c.alpha4, &c.beta1, &c.beta2};
    for (const NumberRow& row : block.rows) {
        const int l = static_cast<int>(c.alpha1.size());
        if (row.values[0] != l)
            throw input_error(row.where, fmt::format("l = {:g} where l = {} is expected", row.values[0], l),
                              "orders count up from 0");
        if (l > largest_order) throw input_error(row.where, fmt::format("more than {} orders", largest_order));
        for (std::size_t i = 0; i < std::size(columns); ++i) columns[i]->push_back(row.values[i + 1]);
        if (l == 0 && std::abs(c.alpha1[0] - 1.0) > 1e-6)
            throw input_error(row.where, fmt::format("alpha1 of l = 0 is {:g}", c.alpha1[0]),
                              "the scattering matrix is normalised so that it is 1");
        for (const auto* column : columns) {
            // |d^l_mn| <= 1, and a2 +- a3 reach twice a1.
            const bool of_a_sum = column == &c.alpha2 || column == &c.alpha3;
            const double limit = (of_a_sum ? 2.0 : 1.0) * (2.0 * l + 1.0);
            if (std::abs(column->back()) > limit * (1 + 1e-6))
                throw input_error(row.where, fmt::format("a coefficient of l = {} is {:g}", l, column->back()),
                                  fmt::format("where no element of the scattering matrix exceeds a1 it is at most "
                                              "{}2l+1 = {:g}",
                                              of_a_sum ? "twice " : "", limit));
        }
    }
    expect_possible(c, block.rows.front().where);
    return c;
}

optics::ExpansionCoefficients expand_block(const Block& block) {
    optics::ScatteringTable table;
    for (const NumberRow& row : block.rows) {
        table.angles_deg.push_back(row.values[0]);
        std::vector<double>* const columns[] = {&table.a1, &table.b1, &table.a2, &table.a3, &table.b2, &table.a4};
        for (std::size_t i = 0; i < std::size(columns); ++i) columns[i]->push_back(row.values[i + 1]);
    }
    return optics::expand(table, matrix_tolerance, block.rows.front().where);
}

}  // namespace

Laws read_expansion_csv(const std::filesystem::path& path) {
    Laws laws;
    for (const Block& block : blocks_of(read_number_csv(path, expansion_headers), path))
        laws.push_back({block.wavelength_nm, coefficients_of(block)});
    return laws;
}

Laws read_matrix_csv(const std::filesystem::path& path) {
    Laws laws;
    for (const Block& block : blocks_of(read_number_csv(path, matrix_headers), path))
        laws.push_back({block.wavelength_nm, expand_block(block)});
    return laws;
}

std::vector<optics::ExternalParticles::CrossSections> read_cross_sections_csv(const std::filesystem::path& path) {
    std::vector<optics::ExternalParticles::CrossSections> rows;
    for (const NumberRow& row : read_number_csv(path, cross_section_headers).rows) {
        const double wavelength = row.values[0], extinction = row.values[1], scattering = row.values[2];
        expect_next_wavelength(wavelength, rows.empty() ? 0.0 : rows.back().wavelength_nm, row.where);
        if (!(extinction >= 0.0 && scattering >= 0.0 && scattering <= extinction * (1 + 1e-6)))
            throw input_error(row.where,
                              fmt::format("extinction {:g} um^2 and scattering {:g} um^2", extinction, scattering),
                              "a particle scatters at least nothing and at most what it takes out of the beam");
        rows.push_back({wavelength, extinction, std::min(scattering, extinction)});
    }
    if (rows.empty()) throw input_error({path.string()}, "no cross sections");
    return rows;
}

optics::ExpansionCoefficients only_law(Laws laws, const std::filesystem::path& path) {
    if (laws.front().wavelength_nm != 0.0)
        throw input_error({path.string()}, "the file gives wavelengths",
                          "a layer in optical terms is the same at all of them",
                          "leave the column wavelength_nm out, or use the file for a pigment");
    return std::move(laws.front().expansion);
}

}  // namespace patina::coating
