#include "patina/render/phases/mie.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/optics/scattering/particle_ensemble.h"
#include "patina/render/bsdf.h"
#include "patina/render/indices.h"

namespace patina::render {

namespace {

constexpr int step_nm = 10;
constexpr double tolerance = 1e-5;  // below what the table's interpolation leaves

double positive(const Properties& node, const char* name) {
    const double value = node.number(name);
    if (!(value > 0) || !std::isfinite(value))
        throw input_error(node.location_of(name), fmt::format("{} must be positive", name),
                          fmt::format("it is {}", value));
    return value;
}

// The distributions and keys of a recipe (docs/formats/recipe.md).
optics::SizeDistribution size_distribution(const Properties& node) {
    const std::string name = node.string("distribution", "mono");
    optics::SizeDistribution distribution;
    if (name == "mono") {
        distribution.shape = optics::Monodisperse{positive(node, "radius_um")};
    } else if (name == "lognormal") {
        distribution.shape = optics::LogNormal{positive(node, "median_radius_um"), positive(node, "sigma_g")};
    } else if (name == "gamma") {
        distribution.shape = optics::Gamma{positive(node, "effective_radius_um"), positive(node, "effective_variance")};
    } else {
        throw input_error(node.location_of("distribution"), fmt::format("unknown distribution \"{}\"", name), "",
                          did_you_mean(name, {"mono", "lognormal", "gamma"}));
    }
    const std::string weighting = node.string("weighting", "number");
    if (weighting == "area")
        distribution.weighting = optics::SizeWeighting::area;
    else if (weighting == "volume")
        distribution.weighting = optics::SizeWeighting::volume;
    else if (weighting != "number")
        throw input_error(node.location_of("weighting"), fmt::format("unknown weighting \"{}\"", weighting), "",
                          did_you_mean(weighting, {"number", "area", "volume"}));
    optics::validate(distribution, node.where);
    return distribution;
}

}  // namespace

PluginDescriptor MiePhase::describe() {
    return {"phase",
            "mie",
            "Spheres of a material in a binder (Lorenz-Mie), polarized.",
            {{"material", "material", "", "", "", "of the spheres; or eta and k"},
             {"eta", "spectrum", "", "", "> 0", "real part of the spheres' index"},
             {"k", "spectrum", "", "", ">= 0", "imaginary part"},
             {"binder", "number, medium, material or spectrum", "", "vacuum", "0.1 .. 10", "index around the spheres"},
             {"distribution", "string", "", "mono", "mono, lognormal, gamma", "of the radii"},
             {"weighting", "string", "", "number", "number, area, volume", "what the distribution counts"},
             {"radius_um", "number", "um", "", "> 0", "mono"},
             {"median_radius_um", "number", "um", "", "> 0", "lognormal"},
             {"sigma_g", "number", "", "", "> 1", "lognormal: geometric standard deviation"},
             {"effective_radius_um", "number", "um", "", "> 0", "gamma: <r^3>/<r^2>"},
             {"effective_variance", "number", "", "", "0 .. 0.5", "gamma"}}};
}

MiePhase MiePhase::build(const Properties& node, const PhaseBuilder& builder) {
    if (!node.has("material") && !node.has("eta"))
        throw input_error(node.where, "mie needs the spheres' material", "none is given",
                          "add <string name=\"material\" value=\"TiO2\"/> or eta and k");
    const BsdfBuilder indices{builder.resources, {}, builder.notes};
    const ConductorIndex particle = conductor_index(node, indices);
    const Spectrum binder = real_index(node, "binder", "vacuum", indices);
    const optics::SizeDistribution sizes = size_distribution(node);

    std::vector<optics::ExpansionCoefficients> expansions;
    for (int nm = 380; nm <= 780; nm += step_nm) {
        const Wavelengths w = Wavelengths::all_at(static_cast<float>(nm));
        const std::complex<double> index(particle.n.at(w)[0], particle.k.at(w)[0]);
        optics::ScatteringOptions options;
        options.tolerance = tolerance;
        expansions.push_back(optics::scatter(index, binder.at(w)[0], nm, sizes, options, node.where).expansion);
    }
    return {std::make_shared<const PhaseTable>(expansions, 380, step_nm)};
}

}  // namespace patina::render
