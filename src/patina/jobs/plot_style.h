#pragma once
// The looks all figures share.

#include <array>
#include <string>

#include <fmt/format.h>

#include "patina/brdf/mueller_table.h"
#include "patina/jobs/plot.h"
#include "patina/jobs/plot_gnuplot.h"

namespace patina::jobs {

// Exit angles end here: polynomials in mu are least certain, and nothing is seen, at the horizon itself.
inline constexpr double largest_exit_angle_deg = 85.0;

// Distinct for the colour-blind (Okabe & Ito 2008), and in brightness.
inline constexpr std::array<const char*, 8> curve_colors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                            "#E69F00", "#56B4E9", "#000000", "#7F7F7F"};

// Perceptually even and readable in grey: anchors of viridis (Smith & van der Walt 2015).
inline constexpr const char* sequential_palette =
    "set palette defined (0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', 4 '#21918c', 5 '#28ae80', 6 '#5ec962', "
    "7 '#addc30', 8 '#fde725')";

// Blue - white - red, white at zero.
inline constexpr const char* diverging_palette =
    "set palette defined (-1 '#053061', -0.75 '#2166ac', -0.5 '#4393c3', -0.25 '#92c5de', 0 '#f7f7f7', 0.25 '#f4a582', "
    "0.5 '#d6604d', 0.75 '#b2182b', 1 '#67001f')";

// The figure's body of commands, for one kind.
struct Figure {
    GnuplotScript script;
    FigureSize size;
};
Figure curve_figure(std::span<const PlottedTable> tables, const PlotRequest& request);
Figure map_figure(const brdf::MuellerTable& table, const PlotRequest& request);

// "0.05, 0.1, 0.2, 0.5, ...": the smallest of 1, 2, 5 times a power of ten that makes at most `intervals` of [0,
// largest].
double nice_step(double largest, int intervals);

}  // namespace patina::jobs
