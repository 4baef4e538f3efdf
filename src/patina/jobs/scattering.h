#pragma once
// Single scattering of a recipe's layers: what radiative transfer starts from, to look at or to take elsewhere.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "patina/coating/recipe.h"
#include "patina/optics/scattering/mixture.h"

namespace patina::jobs {

// One kind of particle in its layer; of particles that interfere the cross sections in the packing.
struct ParticleScattering {
    std::string name;
    double volume_fraction;
    optics::MixtureComponent particles;
};

struct LayerScattering {
    int layer;                            // from the top, 0 first
    std::optional<double> wavelength_nm;  // none for a recipe that is the same at all
    std::string name;                     // the binder, or "optical terms"
    std::optional<double> thickness_um;   // none for a layer in optical terms
    double refractive_index;
    double optical_thickness;  // may be infinite
    double albedo;
    optics::ExpansionCoefficients expansion;
    std::vector<ParticleScattering> pigments;

    double asymmetry() const { return expansion.asymmetry(); }
    // Per um; none without a thickness.
    std::optional<double> extinction_per_um() const;
};

struct ScatteringResult {
    std::vector<LayerScattering> layers;  // of the first wavelength, then of the next
    std::vector<std::string> notes, citations;
};

// `wavelengths_nm` ascending, empty for a recipe that does not depend on it. `tolerance` as in optical_problem().
// Throws Error(usage) for a recipe that depends on wavelength when none is given, and Error(input) as that does.
ScatteringResult scattering(const coating::Recipe& recipe, const std::vector<double>& wavelengths_nm, double tolerance);

// Files in the formats that recipes read (docs/formats/scattering_csv.md), of one layer at all its wavelengths: the
// coefficients, and the matrix at scattering angles in degrees. A single wavelength stands in the file's comment only.
void write_expansion_csv(const std::vector<LayerScattering>& layers, const std::filesystem::path& path);
void write_matrix_csv(const std::vector<LayerScattering>& layers, const std::vector<double>& angles_deg,
                      const std::filesystem::path& path);

}  // namespace patina::jobs
