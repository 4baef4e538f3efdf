#include "patina/coating/spectral_medium.h"

#include <set>

#include <fmt/format.h>

#include "patina/coating/optical_problem.h"
#include "patina/coating/paint_metrics_stack.h"
#include "patina/core/contract.h"
#include "patina/core/parallel.h"

namespace patina::coating {

optics::SpectralMedium spectral_medium(const Recipe& recipe, int layer, double first_nm, double step_nm, int count,
                                       double tolerance) {
    PATINA_EXPECT(count > 0 && step_nm > 0);
    const int layers = static_cast<int>(recipe.layers.size());
    const int chosen = layer < 0 ? variable_layer(recipe).index : layer;
    if (chosen >= layers)
        throw input_error({recipe.path}, fmt::format("there is no layer {}", chosen),
                          fmt::format("the recipe has {}", layers), "the topmost is 0");
    const auto* composition = std::get_if<Composition>(&recipe.layers[chosen].content);
    if (!composition)
        throw input_error({recipe.path}, fmt::format("layer {} cannot fill space", chosen),
                          "it is given by its optical thickness and has no length",
                          "give it by thickness_um and pigments, or take a homogeneous medium");
    if (!(composition->thickness_um > 0))
        throw input_error({recipe.path}, fmt::format("layer {} cannot fill space", chosen), "its thickness is 0",
                          "any thickness_um above 0 will do: it does not matter here");

    // Set up every wavelength; the layer's thickness only converts its optical thickness back.
    std::vector<OpticalProblem> problems(static_cast<std::size_t>(count));
    parallel_for(0, count, [&](std::ptrdiff_t w) {
        problems[static_cast<std::size_t>(w)] =
            optical_problem(recipe, first_nm + step_nm * static_cast<double>(w), tolerance);
    });
    optics::SpectralMedium medium{first_nm, step_nm, {}, {}, {}, {}};
    std::set<std::string> notes, citations;
    for (OpticalProblem& optical : problems) {
        rt::Layer& found = optical.problem.layers[static_cast<std::size_t>(chosen)];
        optics::ScatteringMedium at;
        at.extinction_per_um = found.optical_thickness / composition->thickness_um;
        at.scattering_per_um = at.extinction_per_um * found.single_scattering_albedo;
        at.absorption_per_um = at.extinction_per_um - at.scattering_per_um;
        at.expansion = std::move(found.expansion);
        medium.media.push_back(std::move(at));
        medium.host_index.push_back(found.refractive_index);
        notes.insert(optical.notes.begin(), optical.notes.end());
        citations.insert(optical.citations.begin(), optical.citations.end());
    }
    medium.notes.assign(notes.begin(), notes.end());
    medium.citations.assign(citations.begin(), citations.end());
    return medium;
}

}  // namespace patina::coating
