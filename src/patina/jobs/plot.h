#pragma once
// `patina plot`: figures of BRDF tables, drawn by gnuplot.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "patina/brdf/mueller_table.h"

namespace patina::jobs {

enum class PlotKind {
    lobe,      // f00 in the plane of incidence as a polar curve, coloured by the degree of linear polarization
    polar,     // f00 and DoLP over the exit hemisphere
    mueller,   // the 4x4 elements over the exit hemisphere, divided by M00
    dolp,      // degree of linear polarization against the exit angle in the plane of incidence
    aolp,      // angle of linear polarization over the exit hemisphere
    spectrum,  // directional-hemispherical reflectance against wavelength
    albedo     // directional-hemispherical reflectance against the angle of incidence
};

// Names as on the command line, in the order of the enumeration.
const std::vector<std::string>& plot_kind_names();
// Throws Error(usage) with a suggestion for an unknown name.
PlotKind plot_kind_named(std::string_view name);

// A table with the name it has in the legend ("" = none); the table must outlive the call.
struct PlottedTable {
    const brdf::MuellerTable* table = nullptr;
    std::string label;
    std::string color;  // "#rrggbb" of its curve, for instance its paint's own; "" = the next of the palette
};

struct PlotRequest {
    PlotKind kind = PlotKind::lobe;
    double theta_i_deg = 45.0;     // 0 .. 89
    double wavelength_nm = 550.0;  // clamped to the table's range
    std::string title;             // "" = made from the request
};

// Draws the figure for unpolarized incidence, body part only unless the figure says otherwise, as .png or .svg. Kinds
// `mueller`, `polar` and `aolp` show one table, the others overlay up to eight. Throws Error(usage) for what cannot be
// drawn, Error(not_built) without gnuplot.
void plot(std::span<const PlottedTable> tables, const PlotRequest& request, const std::filesystem::path& path);
void plot(const brdf::MuellerTable& table, const PlotRequest& request, const std::filesystem::path& path);

}  // namespace patina::jobs
