#pragma once
// A computed or measured BRDF table as what a coating lies on.

#include <filesystem>
#include <memory>
#include <optional>

#include "patina/brdf/mueller_table.h"
#include "patina/rt/problem.h"

namespace patina::coating {

// The table's directions are those in a medium of some refractive index: 1 for a surface measured in air, or a coating
// solved with its interface to air; the host's for a coating solved with an index-matched top. Where the lowest layer's
// index differs, light refracts between the two at a smooth interface: a surface measured in air is then seen through a
// thin gap of air, which is all that its table can tell.
struct TableBase {
    std::filesystem::path file;
    std::shared_ptr<const brdf::MuellerTable> table;
    std::optional<double> refractive_index;  // overrides what the file records

    // Index of the table's medium at a wavelength; nothing when neither file nor recipe tells it.
    std::optional<double> medium_index(double wavelength_nm) const;
};

// Notes of a table's provenance that tell the index of the medium its directions are in: one number, or one a
// wavelength, separated by blanks.
inline constexpr const char* medium_index_note = "directions_in_index";

// Reads .h5 (our table) or .pbsdf (measured in air; brought to Fourier modes). Throws Error(input).
std::shared_ptr<const brdf::MuellerTable> read_base_table(const std::filesystem::path& path);

// The table at one wavelength, linear between its own, as the solver asks for it.
std::shared_ptr<const rt::SurfaceReflection> surface_of(const TableBase& base, double wavelength_nm);

}  // namespace patina::coating
