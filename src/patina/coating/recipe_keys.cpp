#include <array>

#include "patina/coating/key_info.h"
#include "patina/core/contract.h"

namespace patina::coating {

namespace {

using enum KeyType;

constexpr std::array top_keys{
    KeyInfo{"title", text, "", "", "what this coating is, for people"},
    KeyInfo{"extrapolation", text, "", "refuse",
            "\"refuse\" | \"hold\": what to do outside a material's measured wavelengths (hold is flagged)"},
    KeyInfo{"volume_solids", number, "1", "",
            "dry volume / volume of the wet paint, for spreading rates; of layers that give none of their own", 0.0,
            1.0, true},
    KeyInfo{"interface", table, "", "", "the top of the coating; omit for an index-matched top"},
    KeyInfo{"layers", array, "", "", "the layers, top to bottom"},
    KeyInfo{"base", table, "", "", "what the coating lies on; omit for none"},
};

constexpr std::array interface_keys{
    KeyInfo{"type", text, "", "smooth",
            "\"smooth\" | \"rough\": a Fresnel interface between air and the first layer, plane or of facets"},
    KeyInfo{"alpha", number, "1", "", "rough: width of the slopes of the facets", 0.04, 1.0},
    KeyInfo{"distribution", text, "", "ggx", "rough: \"ggx\" | \"beckmann\": of the facets' slopes"},
};

constexpr std::array layer_keys{
    KeyInfo{"name", text, "", "", "for people"},
    KeyInfo{"thickness_um", number, "um", "", "dry film thickness", 0.0, 1e7},
    KeyInfo{"binder", text, "", "", "a built-in material, an n,k file, or { n = 1.5, k = 0 }"},
    KeyInfo{"binder_density_g_cm3", number, "g/cm3", "", "of the binder, for pigments given by weight", 0.01, 30.0},
    KeyInfo{"pigments", array, "", "", "the particles in the binder"},
    KeyInfo{"packing", text, "", "auto",
            "\"auto\" | \"percus-yevick\" | \"independent\": interference of densely packed particles (auto: from a "
            "total volume fraction of 0.05 on)"},
    KeyInfo{"volume_solids", number, "1", "", "dry volume / volume of the wet paint, for spreading rates", 0.0, 1.0,
            true},
    KeyInfo{"optical_thickness", number, "1", "",
            "in place of a composition: extinction optical thickness, may be inf for the lowest layer", 0.0,
            std::numeric_limits<double>::infinity(), false, true},
    KeyInfo{"single_scattering_albedo", number, "1", "", "in place of a composition", 0.0, 1.0},
    KeyInfo{"expansion", text, "", "",
            "in place of a composition: CSV file with header l,alpha1,alpha2,alpha3,alpha4,beta1,beta2"},
    KeyInfo{"matrix", text, "", "",
            "in place of expansion: CSV file with header angle_deg,F11,F12,F22,F33,F34,F44, from 0 to 180 degrees"},
    KeyInfo{"refractive_index", number, "1", "1", "of a layer given in optical terms", 0.1, 10.0},
};

constexpr std::array pigment_keys{
    KeyInfo{"material", text, "", "", "a built-in material, an n,k file, or { n = 2.75, k = 0 }"},
    KeyInfo{"material_ordinary", text, "", "",
            "in place of material, birefringent particles of any orientation: the material of the ordinary ray"},
    KeyInfo{"material_extraordinary", text, "", "", "the material of the extraordinary ray"},
    KeyInfo{"volume_fraction", number, "1", "", "volume of the particles / volume of the dry film (PVC / 100)", 0.0,
            0.74, true},
    KeyInfo{"pvc_percent", number, "%", "",
            "in place of volume_fraction: pigment volume concentration (ASTM D5146), of a film without voids", 0.0,
            74.0, true},
    KeyInfo{"weight_percent", number, "%", "",
            "in place of volume_fraction: mass of the particles in the dry film; needs all densities", 0.0, 100.0,
            true},
    KeyInfo{"number_density_per_um3", number, "1/um3", "",
            "in place of volume_fraction: particles in a volume of the dry film", 0.0, 1e12, true},
    KeyInfo{"density_g_cm3", number, "g/cm3", "", "of the pigment, for concentrations by weight", 0.01, 30.0},
    KeyInfo{"size", table, "", "", "the size distribution of the particles' radii"},
    KeyInfo{"matrix", text, "", "",
            "in place of material and size: CSV file of scattering matrices, header [wavelength_nm,]"
            "angle_deg,F11,F12,F22,F33,F34,F44"},
    KeyInfo{"expansion", text, "", "",
            "in place of material and size: CSV file of coefficients, header [wavelength_nm,]"
            "l,alpha1,alpha2,alpha3,alpha4,beta1,beta2"},
    KeyInfo{"cross_sections", text, "", "",
            "with matrix or expansion: CSV file wavelength_nm,extinction_um2,scattering_um2, per particle"},
    KeyInfo{"extinction_um2", number, "um2", "", "in place of cross_sections: the same at every wavelength", 0.0, 1e9},
    KeyInfo{"scattering_um2", number, "um2", "", "in place of cross_sections: the same at every wavelength", 0.0, 1e9},
    KeyInfo{"particle_volume_um3", number, "um3", "", "with matrix or expansion: mean volume of a particle", 1e-15,
            1e10},
};

constexpr std::array size_keys{
    KeyInfo{"distribution", text, "", "",
            "\"mono\" | \"lognormal\" | \"gamma\" | \"modified-gamma\" | \"power-law\" | \"rosin-rammler\" | "
            "\"histogram\""},
    KeyInfo{"weighting", text, "", "number", "\"number\" | \"area\" | \"volume\": what the distribution counts"},
    KeyInfo{"radius_um", number, "um", "", "mono: the radius", 1e-4, 1e3},
    KeyInfo{"median_radius_um", number, "um", "", "lognormal: half of what is counted lies below it", 1e-4, 1e3},
    KeyInfo{"sigma_g", number, "1", "", "lognormal: the geometric standard deviation", 1.0, 5.0, true},
    KeyInfo{"effective_radius_um", number, "um", "", "gamma: <r^3>/<r^2>", 1e-4, 1e3},
    KeyInfo{"effective_variance", number, "1", "", "gamma: the effective variance", 0.0, 0.5, true},
    KeyInfo{"alpha", number, "1", "", "modified-gamma: n ~ r^alpha exp(-(alpha/gamma) (r/mode)^gamma)", 0.0, 100.0,
            true},
    KeyInfo{"gamma", number, "1", "", "modified-gamma: the exponent of the decay", 0.0, 20.0, true},
    KeyInfo{"mode_radius_um", number, "um", "", "modified-gamma: the most frequent radius", 1e-4, 1e3},
    KeyInfo{"exponent", number, "1", "", "power-law: n ~ r^-exponent", -20.0, 20.0},
    KeyInfo{"min_radius_um", number, "um", "", "power-law: the lower cut-off", 1e-4, 1e3},
    KeyInfo{"max_radius_um", number, "um", "", "power-law: the upper cut-off", 1e-4, 1e3},
    KeyInfo{"scale_radius_um", number, "um", "", "rosin-rammler: the fraction above r is exp(-(r/scale)^spread)", 1e-4,
            1e3},
    KeyInfo{"spread", number, "1", "", "rosin-rammler: the exponent", 0.0, 50.0, true},
    KeyInfo{"edges_um", array, "um", "", "histogram: ascending edges of the classes, one more than fractions", 1e-4,
            1e3},
    KeyInfo{"fractions", array, "1", "", "histogram: what lies in each class, in any scale", 0.0, 1e300},
};

constexpr std::array base_keys{
    KeyInfo{"type", text, "", "none", "\"none\" | \"lambertian\" | \"metal\" | \"recipe\" | \"table\""},
    KeyInfo{"reflectance", number, "1", "", "lambertian: 0 to 1, or a spectrum file (.spd, .csv)", 0.0, 1.0},
    KeyInfo{"material", text, "", "", "metal: a built-in material, an n,k file, or { n = 1.0, k = 6.6 }"},
    KeyInfo{"alpha", number, "1", "", "metal: width of the slopes of a rough surface's facets; omit for a mirror", 0.04,
            1.0},
    KeyInfo{"distribution", text, "", "ggx", "metal with alpha: \"ggx\" | \"beckmann\": of the facets' slopes"},
    KeyInfo{"recipe", text, "", "",
            "recipe: file of another coating, whose layers and base lie below this one's layers"},
    KeyInfo{"file", text, "", "", "table: a computed (.h5) or measured (.pbsdf) Mueller BRDF"},
    KeyInfo{"refractive_index", number, "1", "",
            "table: of the medium that its directions are in; omit for what the file records (1: a surface in air)",
            1.0, 10.0},
};

constexpr std::array tables{
    TableInfo{"", "the recipe", top_keys},
    TableInfo{"[interface]", "the top of the coating", interface_keys},
    TableInfo{"[[layers]]", "a homogeneous layer, by composition or in optical terms", layer_keys},
    TableInfo{"[[layers.pigments]]", "one kind of particles", pigment_keys},
    TableInfo{"size", "the size distribution of a pigment", size_keys},
    TableInfo{"[base]", "what the coating lies on", base_keys},
};

}  // namespace

std::span<const TableInfo> recipe_tables() {
    return tables;
}

std::span<const KeyInfo> recipe_keys(std::string_view heading) {
    for (const TableInfo& info : tables)
        if (info.heading == heading) return info.keys;
    PATINA_EXPECT(!"a heading of recipe_tables()");
    return {};
}

}  // namespace patina::coating
