#include "patina/io/table_csv.h"

#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/core/files.h"

namespace patina::io {

namespace {

std::vector<double> cosines(const std::vector<double>& angles_deg, const char* name, const std::string& file) {
    std::vector<double> result;
    for (double angle : angles_deg) {
        if (!(angle >= 0 && angle <= 90))
            throw input_error({file}, fmt::format("{} is {}", name, angle), "it must lie in 0 .. 90 deg");
        result.push_back(std::cos(radians(angle)));
    }
    return result;
}

}  // namespace

void write_table_csv(const brdf::MuellerTable& table, const std::filesystem::path& path, const CsvGrid& grid) {
    const std::vector<double> mu_i = cosines(grid.theta_i_deg, "theta_i_deg", path.string());
    const std::vector<double> mu_o = cosines(grid.theta_o_deg, "theta_o_deg", path.string());
    std::vector<double> phi;
    for (double angle : grid.phi_deg) phi.push_back(radians(angle));

    std::string text = "wavelength_nm,theta_i_deg,theta_o_deg,phi_deg";
    for (int k = 0; k < 16; ++k) text += fmt::format(",m{}{}", k / 4, k % 4);
    text += '\n';
    for (double wavelength_nm : grid.wavelengths_nm.empty() ? table.wavelengths_nm : grid.wavelengths_nm) {
        const brdf::MuellerGrid values = table.evaluate_grid(wavelength_nm, mu_o, mu_i, phi);
        for (int i = 0; i < values.incident; ++i)
            for (int o = 0; o < values.outgoing; ++o)
                for (int p = 0; p < values.azimuths; ++p) {
                    fmt::format_to(std::back_inserter(text), "{:g},{:g},{:g},{:g}", wavelength_nm, grid.theta_i_deg[i],
                                   grid.theta_o_deg[o], grid.phi_deg[p]);
                    const optics::Mueller& mueller = values.at(o, i, p);
                    for (int k = 0; k < 16; ++k)
                        fmt::format_to(std::back_inserter(text), ",{:.9g}", mueller(k / 4, k % 4));
                    text += '\n';
                }
    }
    write_text_file(path, text);
}

}  // namespace patina::io
