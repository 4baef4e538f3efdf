#include "patina/coating/table_base.h"

#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "patina/brdf/half_angle_table.h"
#include "patina/brdf/interpolation.h"
#include "patina/brdf/tabulate.h"
#include "patina/io/table_hdf5.h"
#include "patina/io/table_pbsdf.h"

namespace patina::coating {

namespace {

class TableSurface final : public rt::SurfaceReflection {
  public:
    TableSurface(std::shared_ptr<const brdf::MuellerTable> table, double wavelength_nm)
        : table_(std::move(table)), wavelength_nm_(wavelength_nm) {}

    int order() const override { return table_->orders(wavelength_nm_) - 1; }
    Eigen::MatrixXd mode(int m, const Eigen::VectorXd& mu) const override {
        const std::span<const double> cosines(mu.data(), static_cast<std::size_t>(mu.size()));
        return table_->mode(wavelength_nm_, m, cosines, cosines);
    }
    double albedo(double mu) const override { return table_->body_albedo(wavelength_nm_, mu); }
    optics::Mueller specular(double mu) const override { return table_->specular(wavelength_nm_, mu); }

  private:
    std::shared_ptr<const brdf::MuellerTable> table_;
    double wavelength_nm_;
};

// A measured table on Gauss nodes; the grid of the file sets how fine they can be.
brdf::MuellerTable from_half_angles(const brdf::HalfAngleTable& measured) {
    constexpr int nodes = 32, orders = 48;
    brdf::MuellerTable table =
        brdf::tabulate([&](double wavelength_nm, double mu_o, double mu_i,
                           double phi) { return measured.evaluate_meridian(wavelength_nm, mu_o, mu_i, phi); },
                       {measured.wavelengths_nm, nodes, orders});
    table.provenance.notes.emplace(medium_index_note, "1");
    return table;
}

std::vector<double> numbers_in(const std::string& text) {
    std::istringstream stream(text);
    std::vector<double> values;
    for (double value = 0.0; stream >> value;) values.push_back(value);
    return stream.eof() ? values : std::vector<double>{};
}

}  // namespace

std::optional<double> TableBase::medium_index(double wavelength_nm) const {
    if (refractive_index) return refractive_index;
    const auto note = table->provenance.notes.find(medium_index_note);
    if (note == table->provenance.notes.end()) return std::nullopt;
    const std::vector<double> values = numbers_in(note->second);
    for (const double value : values)
        if (!(value >= 1.0 && value <= 10.0)) return std::nullopt;
    if (values.size() == 1) return values.front();
    if (values.size() != table->wavelengths_nm.size()) return std::nullopt;
    const brdf::LinearInterval interval = brdf::linear_interval(table->wavelengths_nm, wavelength_nm);
    return (1.0 - interval.upper_weight) * values[interval.lower] + interval.upper_weight * values[interval.upper];
}

std::shared_ptr<const brdf::MuellerTable> read_base_table(const std::filesystem::path& path) {
    if (path.extension() == ".h5") {
        auto table = std::make_shared<const brdf::MuellerTable>(io::read_table_hdf5(path));
        // Its modes lack the light that is kept in closed form, which no node follows.
        if (!table->once_scattered.empty())
            throw input_error({path.string()}, "not a table that a coating can lie on",
                              "its particles are so large that light scattered once is kept beside the modes",
                              "let the base be the recipe itself: type = \"recipe\"");
        return table;
    }
    if (path.extension() == ".pbsdf")
        return std::make_shared<const brdf::MuellerTable>(from_half_angles(io::read_table_pbsdf(path)));
    throw input_error({path.string()}, "not a table that a coating can lie on",
                      "its name ends in neither .h5 nor .pbsdf", "patina solve writes .h5");
}

std::shared_ptr<const rt::SurfaceReflection> surface_of(const TableBase& base, double wavelength_nm) {
    return std::make_shared<const TableSurface>(base.table, wavelength_nm);
}

}  // namespace patina::coating
