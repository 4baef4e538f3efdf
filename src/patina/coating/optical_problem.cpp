#include "patina/coating/optical_problem.h"

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/optics/scattering/mixture.h"
#include "patina/optics/scattering/structure_factor.h"

namespace patina::coating {

namespace {

using optics::OpticalConstants;

// From this total volume fraction on, `packing = "auto"` takes the interference between particles into account: there
// it changes the transport cross section of a white pigment by a twentieth (docs/theory.md).
constexpr double automatic_packing_from = 0.05;
constexpr double strongest_binder_absorption = 1e-4;
// Indices this near to each other reflect less than 1e-7 at all but grazing angles.
constexpr double same_index = 1e-3;

// Turns the recipe into numbers at one wavelength and remembers what had to be assumed.
class ProblemBuilder {
  public:
    ProblemBuilder(const Recipe& recipe, double wavelength_nm, double tolerance)
        : recipe_(recipe), wavelength_nm_(wavelength_nm), tolerance_(tolerance) {}

    OpticalProblem build() {
        for (const RecipeLayer& layer : recipe_.layers)
            result_.problem.layers.push_back(
                std::visit([&](const auto& content) { return layer_of(content); }, layer.content));
        result_.problem.refractive_index_above =
            recipe_.has_interface ? 1.0 : result_.problem.layers.front().refractive_index;
        result_.problem.top_roughness = recipe_.has_interface ? recipe_.interface_roughness : std::nullopt;
        result_.problem.base = std::visit([&](const auto& base) { return base_of(base); }, recipe_.base);
        return std::move(result_);
    }

  private:
    rt::Layer layer_of(const OpticalLayer& layer) {
        return {layer.optical_thickness, layer.single_scattering_albedo, layer.expansion, layer.refractive_index};
    }

    rt::Layer layer_of(const Composition& layer) {
        const std::complex<double> host = index_of(layer.binder);
        if (host.imag() > strongest_binder_absorption)
            throw Error(
                ErrorKind::input,
                fmt::format(
                    "binder {}: k = {:g} at {:g} nm (scattering in so absorbing a host is not covered; at most {:g})",
                    layer.binder.name(), host.imag(), wavelength_nm_, strongest_binder_absorption));
        double total_fraction = 0.0;
        for (const Pigment& pigment : layer.pigments) total_fraction += pigment.volume_fraction;

        std::vector<optics::MixtureComponent> components;
        for (const Pigment& pigment : layer.pigments)
            components.push_back(component_of(pigment, host.real(), packing_of(layer, total_fraction)));
        const optics::ScatteringMedium particles = optics::mix(components);

        // The binder absorbs in the volume it fills: 4 pi k / lambda per length.
        const double binder_absorption_per_um =
            4.0 * pi * host.imag() / (1e-3 * wavelength_nm_) * (1.0 - total_fraction);
        const double extinction_per_um = particles.extinction_per_um + binder_absorption_per_um;
        const double albedo = extinction_per_um > 0.0 ? particles.scattering_per_um / extinction_per_um : 0.0;
        return {extinction_per_um * layer.thickness_um, std::min(1.0, albedo), particles.expansion, host.real()};
    }

    optics::MixtureComponent component_of(const Pigment& pigment, double host_index, double packing_fraction) {
        optics::ScatteringOptions options;
        options.tolerance = tolerance_;
        options.packing_fraction = packing_fraction;
        const optics::ScatteringProperties properties =
            optics::scatter(index_of(pigment.material), host_index, wavelength_nm_, pigment.size, options);
        return {properties, pigment.volume_fraction / properties.mean_volume_um3};
    }

    // The volume fraction whose interference counts, 0 for independent particles.
    double packing_of(const Composition& layer, double total_fraction) {
        if (layer.packing == Packing::independent) return 0.0;
        if (layer.packing == Packing::automatic && total_fraction <= automatic_packing_from) return 0.0;
        if (total_fraction == 0.0) return 0.0;
        const double fraction = std::min(total_fraction, optics::max_packing_fraction);
        result_.notes.push_back(fmt::format(
            "particles at a volume fraction of {:g} interfere (Percus-Yevick structure factor{})", total_fraction,
            fraction < total_fraction ? fmt::format(" of {}, random close packing", fraction) : ""));
        return fraction;
    }

    rt::Base base_of(const NoBase&) { return rt::BlackBase{}; }
    rt::Base base_of(const LambertianBase& base) { return rt::LambertianBase{base.reflectance(wavelength_nm_)}; }
    rt::Base base_of(const MetalBase& base) { return rt::MetalBase{index_of(base.material), base.roughness}; }

    rt::Base base_of(const TableBase& base) {
        // The wavelengths of the table.
        const std::vector<double>& known = base.table->wavelengths_nm;
        if (known.size() > 1 && !(wavelength_nm_ >= known.front() && wavelength_nm_ <= known.back())) {
            if (recipe_.extrapolation != optics::Extrapolation::hold)
                throw Error(ErrorKind::input,
                            fmt::format("{}: known from {:g} to {:g} nm, not at {:g} nm "
                                        "(extrapolation = \"hold\" holds its ends)",
                                        base.file.string(), known.front(), known.back(), wavelength_nm_));
            result_.notes.push_back(fmt::format("base {}: known from {:g} to {:g} nm; its ends are held outside",
                                                base.file.filename().string(), known.front(), known.back()));
        }

        // A medium of another index between the layers and the surface.
        const double lowest = result_.problem.layers.back().refractive_index;
        const std::optional<double> medium = base.medium_index(wavelength_nm_);
        PATINA_EXPECT(medium.has_value());
        if (std::abs(*medium - lowest) > same_index) {
            result_.problem.layers.push_back({0.0, 0.0, {{1.0}, {0.0}, {0.0}, {0.0}, {0.0}, {0.0}}, *medium});
            result_.notes.push_back(
                fmt::format("base {}: seen through a smooth interface to the medium of index {:g} its table is for{}",
                            base.file.filename().string(), *medium, *medium == 1.0 ? ", a thin gap of air" : ""));
        }
        return rt::SurfaceBase{surface_of(base, wavelength_nm_)};
    }

    std::complex<double> index_of(const OpticalConstants& material) {
        if (!material.covers(wavelength_nm_) && recipe_.extrapolation == optics::Extrapolation::hold)
            result_.notes.push_back(fmt::format("{} is measured from {:g} to {:g} nm; its ends are held outside",
                                                material.name(), material.wavelength_min_nm(),
                                                material.wavelength_max_nm()));
        result_.citations.push_back(fmt::format("{}: {}", material.name(), material.citation()));
        if (!material.k_known())
            result_.notes.push_back(fmt::format("{}: the source gives no k, taken as 0", material.name()));
        return material.at(wavelength_nm_, recipe_.extrapolation);
    }

    const Recipe& recipe_;
    double wavelength_nm_;
    double tolerance_;
    OpticalProblem result_;
};

}  // namespace

OpticalProblem optical_problem(const Recipe& recipe, double wavelength_nm, double tolerance) {
    return ProblemBuilder(recipe, wavelength_nm, tolerance).build();
}

}  // namespace patina::coating
