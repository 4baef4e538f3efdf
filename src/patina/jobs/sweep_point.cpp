#include "patina/jobs/sweep_point.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "patina/coating/paint_metrics_colour.h"
#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/core/fingerprint.h"
#include "patina/version.h"

namespace patina::jobs {

namespace {

using coating::PaintMetrics;
using nlohmann::json;

constexpr const char* schema = "patina/sweep-point/1";
constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

double luminous(const PaintMetrics& m, const std::vector<double>& reflectance) {
    return coating::tristimulus(m.wavelengths_nm, reflectance, coating::laboratory_viewing)[1];
}

// The mean of the reflectance factors of a band, 45:0 over the own base.
double band(const PaintMetrics& m, double begin_nm, double end_nm) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t w = 0; w < m.wavelengths_nm.size(); ++w)
        if (m.wavelengths_nm[w] >= begin_nm && m.wavelengths_nm[w] <= end_nm) {
            sum += m.own.r45_0[w];
            ++count;
        }
    return count > 0 ? sum / count : undefined;
}

std::size_t nearest(const std::vector<double>& wavelengths_nm, double wavelength_nm) {
    std::size_t best = 0;
    for (std::size_t w = 1; w < wavelengths_nm.size(); ++w)
        if (std::abs(wavelengths_nm[w] - wavelength_nm) < std::abs(wavelengths_nm[best] - wavelength_nm)) best = w;
    return best;
}

json null_for_nan(double value) {
    return std::isfinite(value) ? json(value) : json(nullptr);
}
double nan_for_null(const json& value) {
    return value.is_null() ? undefined : value.get<double>();
}

// The numbers behind names and files of a recipe, at the wavelengths of interest.
class Constants {
  public:
    Constants(const coating::Recipe& recipe, const std::vector<double>& wavelengths_nm)
        : recipe_(recipe), wavelengths_nm_(wavelengths_nm) {
        for (const coating::RecipeLayer& layer : recipe.layers)
            std::visit([&](const auto& content) { add(content); }, layer.content);
        std::visit([&](const auto& base) { add(base); }, recipe.base);
    }
    const std::string& text() const { return text_; }

  private:
    void add(const optics::OpticalConstants& material) {
        for (const double wavelength : wavelengths_nm_) {
            const std::complex<double> index = material.at(wavelength, recipe_.extrapolation);
            text_ += fmt::format("{} {} ", index.real(), index.imag());
        }
    }
    void add(const coating::Composition& layer) {
        add(layer.binder);
        for (const coating::Pigment& pigment : layer.pigments)
            std::visit([&](const auto& particles) { add(particles); }, pigment.particles);
    }
    void add(const coating::Spheres& spheres) {
        add(spheres.material);
        if (spheres.extraordinary) add(*spheres.extraordinary);
    }
    void add(const optics::ExternalParticles& particles) {
        for (const double wavelength : wavelengths_nm_) {
            const optics::ScatteringProperties p = optics::scatter(particles, wavelength, recipe_.extrapolation);
            text_ += fmt::format("{} {} ", p.extinction_um2, p.scattering_um2);
            add(p.expansion);
        }
    }
    void add(const coating::OpticalLayer& layer) { add(layer.expansion); }
    void add(const optics::ExpansionCoefficients& x) {
        for (const auto* values : {&x.alpha1, &x.alpha2, &x.alpha3, &x.alpha4, &x.beta1, &x.beta2})
            text_ += fmt::format("{} ", fmt::join(*values, " "));
    }
    void add(const coating::NoBase&) {}
    void add(const coating::LambertianBase& base) {
        for (const double wavelength : wavelengths_nm_) text_ += fmt::format("{} ", base.reflectance(wavelength));
    }
    void add(const coating::MetalBase& base) { add(base.material); }
    void add(const coating::TableBase& base) {
        // Reflectances at a few angles tell tables apart that have the same name.
        for (const double wavelength : wavelengths_nm_)
            for (const double mu : {0.2, 0.5, 0.9})
                text_ += fmt::format("{} {} ", base.table->body_albedo(wavelength, mu),
                                     base.table->specular(wavelength, mu)(0, 0));
    }

    const coating::Recipe& recipe_;
    const std::vector<double>& wavelengths_nm_;
    std::string text_;
};

}  // namespace

std::vector<SweepQuantity> sweep_quantities(bool optical) {
    const std::string per = optical ? "_per_optical_thickness" : "_per_um", per_unit = optical ? "1" : "1/um";
    return {{"contrast_ratio", "1", "Y over black / Y over white, 45:0, D65, 10 degrees"},
            {"hiding_power_m2_per_l", "m2/l", "spreading rate at the contrast ratio that hides, 45:0"},
            {optical ? "hiding_optical_thickness" : "hiding_thickness_um", optical ? "1" : "um",
             "thickness of the scattering layer that hides"},
            {"luminous_own_base", "1", "Y over the own base, 45:0, D65, 10 degrees"},
            {"luminous_black", "1", "Y over black, 45:0, D65, 10 degrees"},
            {"luminous_white", "1", "Y over the white card, 45:0, D65, 10 degrees"},
            {"luminous_infinite", "1", "Y of the scattering layer without end, 45:0, D65, 10 degrees"},
            {"lab_L", "1", "L* over the own base, 45:0, D65, 10 degrees"},
            {"lab_a", "1", "a* over the own base, 45:0, D65, 10 degrees"},
            {"lab_b", "1", "b* over the own base, 45:0, D65, 10 degrees"},
            {"whiteness", "1", "ASTM E313, over the own base, 45:0, D65, 10 degrees"},
            {"yellowness", "1", "ASTM E313, over the own base, 45:0, D65, 10 degrees"},
            {"reflectance_400_500nm", "1", "mean reflectance factor over the own base, 45:0"},
            {"reflectance_500_600nm", "1", "mean reflectance factor over the own base, 45:0"},
            {"reflectance_600_700nm", "1", "mean reflectance factor over the own base, 45:0"},
            {"kubelka_munk_k" + per, per_unit, "d:8 excluded, Saunderson, at the wavelength nearest 550 nm"},
            {"kubelka_munk_s" + per, per_unit, "d:8 excluded, Saunderson, at the wavelength nearest 550 nm"},
            {"transport_scattering" + per, per_unit, "sigma_s (1 - g) at the wavelength nearest 550 nm"},
            {"absorption" + per, per_unit, "sigma_a at the wavelength nearest 550 nm"}};
}

SweepPoint sweep_point(const PaintMetrics& m) {
    const Eigen::Vector3d lab = coating::lab(m.wavelengths_nm, m.own.r45_0, coating::laboratory_viewing);
    const coating::WhitenessAndYellowness white = coating::whiteness(m.wavelengths_nm, m.own.r45_0);
    const coating::FilmCoefficients& film = m.film[nearest(m.wavelengths_nm, 550.0)];
    SweepPoint point;
    point.quantities = {m.contrast.r45_0,
                        m.hiding.spreading_rate_m2_per_l.value_or(undefined),
                        m.hiding.thickness.value_or(undefined),
                        luminous(m, m.own.r45_0),
                        luminous(m, m.over_black.r45_0),
                        luminous(m, m.over_white.r45_0),
                        luminous(m, m.infinite.r45_0),
                        lab[0],
                        lab[1],
                        lab[2],
                        white.whiteness,
                        white.yellowness,
                        band(m, 400.0, 500.0),
                        band(m, 500.0, 600.0),
                        band(m, 600.0, 700.0),
                        film.kubelka_munk ? film.kubelka_munk->k : undefined,
                        film.kubelka_munk ? film.kubelka_munk->s : undefined,
                        film.transport_scattering,
                        film.absorption};
    point.wavelengths_nm = m.wavelengths_nm;
    point.reflectance_45_0 = m.own.r45_0;
    point.converged = m.converged;
    return point;
}

std::string sweep_point_key(const coating::Recipe& recipe, const coating::PaintOptions& options) {
    const coating::StackOptions& stack = options.stack;
    const std::string all = fmt::format("{}\n{}\n{}\n{}\n{} {} {} {} {}\n{}", schema, PATINA_VERSION, recipe.text,
                                        fmt::join(stack.wavelengths_nm, " "), stack.tolerance, stack.streams,
                                        stack.solver, options.white_reflectance, options.wanted_contrast_ratio,
                                        Constants(recipe, stack.wavelengths_nm).text());
    Fingerprint fingerprint;
    fingerprint.add(all);
    return fingerprint.hex();
}

void write_sweep_point(const std::filesystem::path& path, const std::string& key,
                       const std::vector<SweepQuantity>& quantities, const std::vector<std::string>& settings,
                       const SweepPoint& point) {
    json values = json::object();
    for (std::size_t q = 0; q < quantities.size(); ++q) values[quantities[q].name] = null_for_nan(point.quantities[q]);
    const json document = {{"schema", schema},
                           {"key", key},
                           {"settings", settings},
                           {"quantities", values},
                           {"wavelengths_nm", point.wavelengths_nm},
                           {"reflectance_45_0", point.reflectance_45_0},
                           {"converged", point.converged}};
    write_text_file(path, document.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

std::optional<SweepPoint> read_sweep_point(const std::filesystem::path& path, const std::string& key,
                                           const std::vector<SweepQuantity>& quantities) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
    try {
        const json document = json::parse(read_text_file(path));
        if (document.at("schema") != schema || document.at("key") != key) return std::nullopt;
        SweepPoint point;
        for (const SweepQuantity& quantity : quantities)
            point.quantities.push_back(nan_for_null(document.at("quantities").at(quantity.name)));
        point.wavelengths_nm = document.at("wavelengths_nm").get<std::vector<double>>();
        point.reflectance_45_0 = document.at("reflectance_45_0").get<std::vector<double>>();
        point.converged = document.at("converged").get<bool>();
        if (point.wavelengths_nm.empty() || point.wavelengths_nm.size() != point.reflectance_45_0.size())
            return std::nullopt;
        return point;
    } catch (const json::exception&) {
        return std::nullopt;  // not ours, or edited: it is computed again
    }
}

}  // namespace patina::jobs
