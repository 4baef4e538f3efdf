#include "patina/jobs/compare.h"

#include <cmath>

#include <fmt/format.h>

#include "patina/coating/paint_metrics_colour.h"
#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/spectral/colour_difference.h"

namespace patina::jobs {

namespace {

// Gathers |b - a|.
class Gatherer {
  public:
    void add(double a, double b) {
        sum_of_squares_ += (b - a) * (b - a);
        largest_ = std::max(largest_, std::abs(b - a));
        ++count_;
    }
    Difference result() const { return {count_ > 0 ? std::sqrt(sum_of_squares_ / count_) : 0.0, largest_}; }

  private:
    double sum_of_squares_ = 0.0, largest_ = 0.0;
    int count_ = 0;
};

double dolp(const optics::Mueller& m) {
    return std::hypot(m(1, 0), m(2, 0)) / m(0, 0);
}

// Nearer the horizon neither the nodes nor instruments say anything.
std::vector<double> compared_cosines(const brdf::MuellerTable& table) {
    std::vector<double> cosines;
    for (const double mu : table.mu)
        if (mu >= std::cos(radians(80.0))) cosines.push_back(mu);
    if (cosines.empty()) cosines.push_back(1.0);
    return cosines;
}

TableDifference compare_at(const brdf::MuellerTable& a, const brdf::MuellerTable& b, double wavelength_nm) {
    const std::vector<double> mu = compared_cosines(a);
    std::vector<double> phi;
    for (int step = 0; step <= 12; ++step) phi.push_back(radians(15.0 * step));
    const brdf::MuellerGrid grid_a = a.evaluate_grid(wavelength_nm, mu, mu, phi),
                            grid_b = b.evaluate_grid(wavelength_nm, mu, mu, phi);

    Gatherer f00, degree, albedo;
    std::array<std::array<Gatherer, 4>, 4> elements;
    TableDifference result;
    for (std::size_t k = 0; k < grid_a.values.size(); ++k) {
        const optics::Mueller &m_a = grid_a.values[k], &m_b = grid_b.values[k];
        f00.add(m_a(0, 0), m_b(0, 0));
        result.mean_f00 += m_a(0, 0) / static_cast<double>(grid_a.values.size());
        if (!(m_a(0, 0) > 0.0 && m_b(0, 0) > 0.0)) continue;  // ratios to nothing say nothing
        degree.add(dolp(m_a), dolp(m_b));
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) elements[i][j].add(m_a(i, j) / m_a(0, 0), m_b(i, j) / m_b(0, 0));
    }
    for (const double mu_i : mu) albedo.add(a.body_albedo(wavelength_nm, mu_i), b.body_albedo(wavelength_nm, mu_i));

    result.wavelength_nm = wavelength_nm;
    result.f00 = f00.result();
    result.dolp = degree.result();
    result.albedo = albedo.result();
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) result.mueller[i][j] = elements[i][j].result();
    return result;
}

}  // namespace

std::vector<TableDifference> compare_tables(const brdf::MuellerTable& a, const brdf::MuellerTable& b) {
    std::vector<TableDifference> result;
    for (const double wavelength : a.wavelengths_nm)
        if (wavelength >= b.wavelengths_nm.front() && wavelength <= b.wavelengths_nm.back())
            result.push_back(compare_at(a, b, wavelength));
    if (result.empty())
        throw Error(
            ErrorKind::input,
            fmt::format("no wavelength of the first table ({:g} to {:g} nm) lies in the second ({:g} to {:g} nm)",
                        a.wavelengths_nm.front(), a.wavelengths_nm.back(), b.wavelengths_nm.front(),
                        b.wavelengths_nm.back()));
    return result;
}

std::vector<ColourDifference> compare_colours(const coating::PaintMetrics& a, const coating::PaintMetrics& b) {
    using coating::ReflectanceSpectra;
    const std::pair<const char*, std::vector<double> ReflectanceSpectra::*> geometries[] = {
        {"45:0", &ReflectanceSpectra::r45_0},
        {"d:8 excluded", &ReflectanceSpectra::d8_excluded},
        {"d:8 included", &ReflectanceSpectra::d8_included}};
    std::vector<ColourDifference> result;
    for (const auto& [name, values] : geometries)
        for (const coating::Viewing& viewing : coating::usual_viewings()) {
            ColourDifference row{name,
                                 std::string(viewing.illuminant),
                                 coating::observer_deg(viewing.observer),
                                 coating::lab(a.wavelengths_nm, a.own.*values, viewing),
                                 coating::lab(b.wavelengths_nm, b.own.*values, viewing),
                                 0.0};
            row.delta_e_2000 = spectral::delta_e_2000(row.lab_a, row.lab_b);
            result.push_back(std::move(row));
        }
    return result;
}

}  // namespace patina::jobs
