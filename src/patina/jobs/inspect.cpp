#include "patina/jobs/inspect.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/coating/recipe.h"
#include "patina/core/error.h"
#include "patina/io/stokes_exr.h"
#include "patina/io/table_hdf5.h"
#include "patina/optics/materials.h"

namespace patina::jobs {

namespace {

using Facts = std::vector<Fact>;

Facts inspect_table(const std::filesystem::path& path) {
    const brdf::MuellerTable table = io::read_table_hdf5(path);
    size_t orders = 0;
    for (const brdf::BodyModes& body : table.body) orders = std::max(orders, body.modes.size());
    Facts facts{
        {"kind", "Mueller BRDF table (HDF5)"},
        {"wavelengths", fmt::format("{} from {:g} to {:g} nm", table.wavelengths_nm.size(),
                                    table.wavelengths_nm.front(), table.wavelengths_nm.back())},
        {"directions",
         fmt::format("{} cosines in air, {:.4f} to {:.4f}", table.mu.size(), table.mu.front(), table.mu.back())},
        {"Fourier orders", std::to_string(orders)},
        {"units", "1/sr; S_out = sum of f S_in cos(theta_i) d omega"},
        {"convention", "Stokes (I,Q,U,V), Q = I_par - I_perp to the meridian plane, exp(-i w t); docs/conventions.md"}};
    if (!table.once_scattered.empty())
        facts.push_back({"once scattered light", "in closed form beside the modes (sharp forward peaks)"});
    for (const double theta_deg : {0.0, 45.0, 75.0})
        facts.push_back({fmt::format("reflectance at {:.0f} deg", theta_deg),
                         fmt::format("{:.4f} (body, unpolarized light, {:g} nm)",
                                     table.body_albedo(table.wavelengths_nm[table.wavelengths_nm.size() / 2],
                                                       std::cos(theta_deg / 57.29577951308232)),
                                     table.wavelengths_nm[table.wavelengths_nm.size() / 2])});
    const brdf::Provenance& p = table.provenance;
    facts.insert(facts.end(),
                 {{"made by", p.software}, {"solver", p.solver}, {"command", p.command}, {"recipe", p.recipe_path}});
    for (const auto& [name, value] : p.notes) facts.push_back({name, value});
    return facts;
}

Facts inspect_picture(const std::filesystem::path& path) {
    const StokesImage image = io::read_stokes_exr(path);
    Facts facts{{"kind", "Stokes picture (OpenEXR)"},
                {"size", fmt::format("{} x {} pixels", image.width, image.height)}};
    if (image.bin_count() > 0)
        facts.push_back({"spectral bins", fmt::format("{} from {:g} to {:g} nm", image.bin_count(),
                                                      image.bin_edges_nm.front(), image.bin_edges_nm.back())});
    facts.push_back(
        {"convention",
         "S1 > 0 horizontal, S2 > 0 at +45 deg, S3 > 0 right circular looking at the source; docs/conventions.md"});
    for (const auto& [name, value] : image.metadata) facts.push_back({name, value});
    return facts;
}

Facts inspect_recipe(const std::filesystem::path& path) {
    const coating::Recipe recipe = coating::read_recipe(path);
    Facts facts{{"kind", "paint recipe"},
                {"title", recipe.title},
                {"top", recipe.has_interface ? "smooth interface to air" : "index matched"}};
    for (size_t i = 0; i < recipe.layers.size(); ++i) {
        const auto* composition = std::get_if<coating::Composition>(&recipe.layers[i].content);
        std::string text = composition
                               ? fmt::format("{:g} um of {}", composition->thickness_um, composition->binder.name())
                               : "given in optical terms";
        if (composition)
            for (const coating::Pigment& pigment : composition->pigments)
                text += fmt::format(", {:g} of {}", pigment.volume_fraction, pigment.name());
        facts.push_back({fmt::format("layer {}", i), text});
    }
    static constexpr const char* bases[] = {"none", "lambertian", "metal"};
    facts.push_back({"base", bases[recipe.base.index()]});
    return facts;
}

Facts inspect_material(const std::filesystem::path& path) {
    const optics::OpticalConstants material = optics::material(path.string());
    return {{"kind", "optical constants"},
            {"name", material.name()},
            {"publication", material.citation()},
            {"range", fmt::format("{:g} to {:g} nm", material.wavelength_min_nm(), material.wavelength_max_nm())},
            {"k", material.k_known() ? "given" : "not given, taken as 0"}};
}

}  // namespace

std::vector<Fact> inspect(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension == ".h5") return inspect_table(path);
    if (extension == ".exr") return inspect_picture(path);
    if (extension == ".toml") return inspect_recipe(path);
    if (extension == ".yml" || extension == ".yaml" || extension == ".csv") return inspect_material(path);
    throw input_error({path.string()}, "not a kind of file patina knows", "it knows .h5, .exr, .toml, .yml, .csv");
}

}  // namespace patina::jobs
