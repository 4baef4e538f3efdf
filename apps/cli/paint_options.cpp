#include "paint_options.h"

namespace patina::cli {

void add_paint_options(CLI::App& command, PaintCommandOptions& options) {
    command.add_option("recipe", options.recipe, "paint recipe (TOML)")->required();
    command.add_option("--wavelengths", options.wavelengths, "vacuum wavelengths in nm (default: 400:700:10)");
    command.add_option("--tolerance", options.tolerance, "relative accuracy wanted")
        ->check(CLI::Range(1e-8, 0.1))
        ->capture_default_str();
    command.add_option("--streams", options.streams,
                       "quadrature nodes per hemisphere in air (default: from the tolerance)");
    command.add_option("--solver", options.solver, "doubling | eigenmodes | montecarlo")->capture_default_str();
    command.add_option("--white", options.white, "reflectance of the white card")->capture_default_str();
    command.add_option("--contrast-ratio", options.contrast, "contrast ratio that counts as hiding")
        ->capture_default_str();
    command.add_option("--set", options.settings, "change a key of the recipe: layers.0.thickness_um=30 (repeatable)")
        ->take_all()
        ->allow_extra_args(false);
}

coating::PaintOptions to_paint_options(const PaintCommandOptions& options) {
    coating::PaintOptions result;
    if (!options.wavelengths.empty())
        result.stack.wavelengths_nm = parse_number_list(options.wavelengths, "--wavelengths");
    result.stack.tolerance = options.tolerance;
    result.stack.streams = options.streams;
    result.stack.solver = options.solver;
    result.white_reflectance = options.white;
    result.wanted_contrast_ratio = options.contrast;
    return result;
}

}  // namespace patina::cli
