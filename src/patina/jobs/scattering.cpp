#include "patina/jobs/scattering.h"

#include <algorithm>

#include <fmt/format.h>

#include "patina/coating/optical_problem.h"
#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/core/parallel.h"
#include "patina/optics/scattering/expansion.h"

namespace patina::jobs {

namespace {

LayerScattering layer_scattering(const coating::Recipe& recipe, const coating::OpticalProblem& optical, std::size_t l) {
    const rt::Layer& layer = optical.problem.layers[l];
    LayerScattering result{.layer = static_cast<int>(l),
                           .wavelength_nm = {},
                           .name = "optical terms",
                           .thickness_um = {},
                           .refractive_index = layer.refractive_index,
                           .optical_thickness = layer.optical_thickness,
                           .albedo = layer.single_scattering_albedo,
                           .expansion = layer.expansion,
                           .pigments = {}};
    if (const auto* composition = std::get_if<coating::Composition>(&recipe.layers[l].content)) {
        result.name = composition->binder.name();
        result.thickness_um = composition->thickness_um;
        for (std::size_t p = 0; p < composition->pigments.size(); ++p)
            result.pigments.push_back(
                {composition->pigments[p].name(), composition->pigments[p].volume_fraction, optical.particles[l][p]});
    }
    return result;
}

void append_new(std::vector<std::string>& all, const std::vector<std::string>& some) {
    for (const std::string& one : some)
        if (std::ranges::find(all, one) == all.end()) all.push_back(one);
}

// A file of one wavelength is for layers in optical terms, which have none; its head tells which it was.
bool has_wavelengths(const std::vector<LayerScattering>& layers) {
    return layers.size() > 1;
}
std::string head(const std::vector<LayerScattering>& layers, const char* columns) {
    const LayerScattering& first = layers.front();
    const bool one = first.wavelength_nm && !has_wavelengths(layers);
    return fmt::format("# layer {}, {}{}\n{}{}\n", first.layer, first.name,
                       one ? fmt::format(", at {:g} nm", *first.wavelength_nm) : "",
                       has_wavelengths(layers) ? "wavelength_nm," : "", columns);
}
std::string first_column(const LayerScattering& layer, bool wanted) {
    return wanted ? fmt::format("{},", *layer.wavelength_nm) : "";
}

}  // namespace

std::optional<double> LayerScattering::extinction_per_um() const {
    if (!thickness_um || !(*thickness_um > 0.0)) return std::nullopt;
    return optical_thickness / *thickness_um;
}

ScatteringResult scattering(const coating::Recipe& recipe, const std::vector<double>& wavelengths_nm,
                            double tolerance) {
    const bool constant = recipe.is_wavelength_independent();
    if (wavelengths_nm.empty() && !constant)
        throw Error(ErrorKind::usage, "this recipe depends on wavelength; give --wavelength-nm");
    // Where nothing depends on it any wavelength will do.
    const std::vector<double> asked = constant ? std::vector{550.0} : wavelengths_nm;
    std::vector<coating::OpticalProblem> problems(asked.size());
    parallel_for(0, std::ssize(asked),
                 [&](std::ptrdiff_t w) { problems[w] = coating::optical_problem(recipe, asked[w], tolerance); });

    ScatteringResult result;
    for (std::size_t w = 0; w < asked.size(); ++w) {
        for (std::size_t l = 0; l < recipe.layers.size(); ++l) {
            result.layers.push_back(layer_scattering(recipe, problems[w], l));
            if (!constant) result.layers.back().wavelength_nm = asked[w];
        }
        append_new(result.notes, problems[w].notes);
        append_new(result.citations, problems[w].citations);
    }
    return result;
}

void write_expansion_csv(const std::vector<LayerScattering>& layers, const std::filesystem::path& path) {
    std::string text = head(layers, "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2");
    for (const LayerScattering& layer : layers) {
        const optics::ExpansionCoefficients& c = layer.expansion;
        for (int l = 0; l <= c.order(); ++l)
            text += fmt::format("{}{},{},{},{},{},{},{}\n", first_column(layer, has_wavelengths(layers)), l,
                                c.alpha1[l], c.alpha2[l], c.alpha3[l], c.alpha4[l], c.beta1[l], c.beta2[l]);
    }
    write_text_file(path, text);
}

void write_matrix_csv(const std::vector<LayerScattering>& layers, const std::vector<double>& angles_deg,
                      const std::filesystem::path& path) {
    std::string text = head(layers, "angle_deg,F11,F12,F22,F33,F34,F44");
    for (const LayerScattering& layer : layers)
        for (const double angle : angles_deg) {
            const optics::ScatteringElements f = optics::evaluate(layer.expansion, std::cos(radians(angle)));
            text += fmt::format("{}{},{},{},{},{},{},{}\n", first_column(layer, has_wavelengths(layers)), angle, f.a1,
                                f.b1, f.a2, f.a3, f.b2, f.a4);
        }
    write_text_file(path, text);
}

}  // namespace patina::jobs
