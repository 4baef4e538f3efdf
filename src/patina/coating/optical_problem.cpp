#include "patina/coating/optical_problem.h"

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/optics/scattering/expansion.h"
#include "patina/optics/scattering/mixture.h"
#include "patina/optics/scattering/packed_mixture.h"
#include "patina/optics/scattering/structure_factor.h"

namespace patina::coating {

namespace {

using optics::OpticalConstants;

// From this total volume fraction on, `packing = "auto"` takes the interference between particles into account: there
// it changes the transport cross section of a white pigment by a twentieth (docs/theory.md).
constexpr double automatic_packing_from = 0.05;
// Refraction takes the binder's n alone. At this k the reflectance of a surface at the normal lacks 4 n k^2/(n+1)^4,
// 4e-4, and light travels a wavelength or two: beyond, neither a real index nor rays make sense.
constexpr double strongest_binder_absorption = 0.05;
constexpr double neglected_reflectance = 5e-4;
// From this k on that is reported.
constexpr double reported_binder_absorption = 1e-3;
// Indices this near to each other reflect less than 1e-7 at all but grazing angles.
constexpr double same_index = 1e-3;
// Six printed digits of a few hundred coefficients leave less, in units of the mean a1.
constexpr double reported_excess = 1e-2;

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
        const auto* metal = std::get_if<rt::MetalBase>(&result_.problem.base);
        if (result_.problem.has_rough_top() || (metal && metal->roughness))
            result_.notes.emplace_back(
                "rough surface: within some degrees of grazing its lobe is smoothed in azimuth, which an error bound "
                "does not include");
        return std::move(result_);
    }

  private:
    rt::Layer layer_of(const OpticalLayer& layer) {
        result_.particles.emplace_back();
        report_impossible(layer.expansion, fmt::format("layer {}", result_.problem.layers.size()));
        return {layer.optical_thickness, layer.single_scattering_albedo, layer.expansion, layer.refractive_index};
    }

    rt::Layer layer_of(const Composition& layer) {
        const std::complex<double> host = binder_index(layer);
        double total_fraction = 0.0;
        for (const Pigment& pigment : layer.pigments) total_fraction += pigment.volume_fraction;

        // One kind is packed with the sizes it has while they are averaged; several are packed together.
        const double packing_fraction = packing_of(layer, total_fraction);
        const bool together = packing_fraction > 0.0 && layer.pigments.size() > 1;
        const double packed_alone = together ? 0.0 : packing_fraction;
        std::vector<optics::MixtureComponent> components;
        for (const Pigment& pigment : layer.pigments) {
            const optics::ScatteringProperties properties = std::visit(
                [&](const auto& particles) { return properties_of(particles, host, packed_alone); }, pigment.particles);
            components.push_back({properties, pigment.volume_fraction / properties.mean_volume_um3});
        }
        if (together) optics::pack(components, host.real(), wavelength_nm_, tolerance_);
        const optics::ScatteringMedium particles = optics::mix(components);
        result_.particles.push_back(std::move(components));

        // The binder absorbs everywhere; what the particles take away by replacing it is in their cross sections.
        const double extinction_per_um = binder_absorption_per_um(host) + particles.extinction_per_um;
        const double absorption_per_um = extinction_per_um - particles.scattering_per_um;
        if (absorption_per_um < -1e-9 * std::abs(particles.scattering_per_um))
            throw Error(ErrorKind::input,
                        fmt::format("layer of {}: more light would leave than enters at {:g} nm (the particles scatter "
                                    "{:g} and the layer extinguishes {:g} per um; with k = {:g} and particles this "
                                    "large the theory of an absorbing binder does not hold); use a smaller k",
                                    layer.binder.name(), wavelength_nm_, particles.scattering_per_um, extinction_per_um,
                                    host.imag()));
        const double albedo = extinction_per_um > 0.0 ? particles.scattering_per_um / extinction_per_um : 0.0;
        return {extinction_per_um * layer.thickness_um, std::clamp(albedo, 0.0, 1.0), particles.expansion, host.real()};
    }

    void report_impossible(const optics::ExpansionCoefficients& expansion, const std::string& name) {
        const optics::StokesCriterion found = optics::stokes_criterion(expansion);
        if (found.excess > reported_excess)
            result_.notes.push_back(
                fmt::format("{}: scattered by {:.0f} degrees light has more polarization than intensity (by {:.2g}, a1 "
                            "being 1 on average): the expansion is cut off, or its columns are mistaken",
                            name, found.angle_deg, found.excess));
    }

    std::complex<double> binder_index(const Composition& layer) {
        const std::complex<double> host = index_of(layer.binder);
        if (host.imag() > strongest_binder_absorption)
            throw Error(
                ErrorKind::input,
                fmt::format("binder {}: k = {:g} at {:g} nm (refraction at its surface would depend on k, and light "
                            "would not get through a wavelength of it; at most {:g})",
                            layer.binder.name(), host.imag(), wavelength_nm_, strongest_binder_absorption));
        if (host.imag() >= reported_binder_absorption)
            result_.notes.push_back(
                fmt::format("binder {} absorbs (k above {:g}): its surface refracts by n alone, which changes its "
                            "reflectance at the "
                            "normal by less than {:g}",
                            layer.binder.name(), reported_binder_absorption, neglected_reflectance));
        return host;
    }

    double binder_absorption_per_um(std::complex<double> host) const {
        return 4.0 * pi * host.imag() / (1e-3 * wavelength_nm_);
    }

    optics::ScatteringProperties properties_of(const Spheres& spheres, std::complex<double> host,
                                               double packing_fraction) {
        optics::ScatteringOptions options;
        options.tolerance = tolerance_;
        options.packing_fraction = packing_fraction;
        const optics::ScatteringProperties ordinary =
            optics::scatter(index_of(spheres.material), host, wavelength_nm_, spheres.size, options);
        if (!spheres.extraordinary) return ordinary;
        result_.notes.push_back(
            fmt::format("{} with {}: birefringent particles as 2/3 and 1/3 isotropic ones (exact cross sections for "
                        "small ones; depolarization by their anisotropy is left out)",
                        spheres.material.name(), spheres.extraordinary->name()));
        return optics::average_birefringent(
            ordinary, optics::scatter(index_of(*spheres.extraordinary), host, wavelength_nm_, spheres.size, options));
    }

    // What is known of them is of a clear host; the binder that they replace is taken off.
    optics::ScatteringProperties properties_of(const optics::ExternalParticles& particles, std::complex<double> host,
                                               double packing_fraction) {
        if (!optics::covers(particles, wavelength_nm_) && recipe_.extrapolation == optics::Extrapolation::hold)
            result_.notes.push_back(fmt::format("{}: its ends are held outside its wavelengths", particles.name));
        const optics::ScatteringProperties alone = optics::scatter(particles, wavelength_nm_, recipe_.extrapolation);
        report_impossible(alone.expansion, particles.name);
        optics::ScatteringProperties properties = optics::pack(alone, packing_fraction, host.real(), wavelength_nm_);
        const double replaced_um2 = binder_absorption_per_um(host) * properties.mean_volume_um3;
        properties.absorption_um2 -= replaced_um2;
        properties.extinction_um2 -= replaced_um2;
        return properties;
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
