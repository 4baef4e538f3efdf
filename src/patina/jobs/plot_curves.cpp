// Figures of curves: lobe, dolp, spectrum, albedo.

#include <algorithm>
#include <cmath>
#include <vector>

#include "patina/core/constants.h"
#include "patina/jobs/plot_style.h"

namespace patina::jobs {

using brdf::MuellerTable;
using optics::Stokes;

namespace {

// The plane of incidence from the light's side (negative angles) to the mirror side.
struct InPlane {
    std::vector<double> theta_deg;
    std::vector<Stokes> reflected;  // for a unit unpolarized irradiance
};

InPlane in_plane(const MuellerTable& table, const PlotRequest& request) {
    InPlane result;
    std::vector<double> mu_o;
    for (double theta = 0; theta <= largest_exit_angle_deg; theta += 0.5) mu_o.push_back(std::cos(radians(theta)));
    const double mu_i[] = {std::cos(radians(request.theta_i_deg))}, phi[] = {0.0, pi};
    const brdf::MuellerGrid grid = table.evaluate_grid(request.wavelength_nm, mu_o, mu_i, phi);
    for (int side : {1, 0})
        for (int k = 0; k < grid.outgoing; ++k) {
            const int o = side == 1 ? grid.outgoing - 1 - k : k;
            if (side == 0 && o == 0) continue;  // the normal belongs to both sides
            result.theta_deg.push_back((side == 1 ? -1 : 1) * degrees(std::acos(mu_o[o])));
            result.reflected.push_back(grid.at(o, 0, side).col(0));
        }
    return result;
}

std::string color_of(const PlottedTable& plotted, std::size_t index) {
    const bool hex = plotted.color.size() == 7 && plotted.color[0] == '#' &&
                     plotted.color.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    return hex ? plotted.color : curve_colors[index];
}

std::string title_or(const PlotRequest& request, const std::string& made) {
    return gnuplot_quoted(request.title.empty() ? made : request.title);
}

// With `legend`, room for it is left below the axis.
void set_curve_axes(GnuplotScript& script, const std::string& title, bool legend) {
    script.line("set border 3 lc rgb '#404040' lw 1.5")
        .line("set tics nomirror out scale 0.6 textcolor rgb '#202020'")
        .line("set grid lt 1 lc rgb '#d4d4d4' lw 1.2")
        .line(legend ? "set key below center horizontal Left reverse samplen 2.5 spacing 1.3 width 2 height 0.6; set "
                       "bmargin 6.6"
                     : "unset key; set bmargin 4.2")
        .line("set lmargin 10; set rmargin 4; set tmargin 3.2")
        .line(fmt::format("set title {} font size18 offset 0,0.3", title));
}

bool has_labels(std::span<const PlottedTable> tables) {
    return std::ranges::any_of(tables, [](const PlottedTable& plotted) { return !plotted.label.empty(); });
}

std::string key_title(const PlottedTable& plotted) {
    return plotted.label.empty() ? "notitle" : "title " + gnuplot_quoted(plotted.label);
}

Figure dolp_figure(std::span<const PlottedTable> tables, const PlotRequest& request) {
    Figure figure;
    GnuplotScript& script = figure.script;
    double largest = 0;
    std::string curves;
    for (std::size_t t = 0; t < tables.size(); ++t) {
        const InPlane plane = in_plane(*tables[t].table, request);
        script.begin_data(fmt::format("d{}", t));
        for (std::size_t k = 0; k < plane.theta_deg.size(); ++k) {
            const double dolp = optics::degree_of_linear_polarization(plane.reflected[k]);
            script.line(fmt::format("{:.4f} {:.6g}", plane.theta_deg[k], dolp));
            largest = std::max(largest, std::min(dolp, 1.0));
        }
        script.end_data();
        curves += fmt::format("{}$d{} using 1:2 with lines lw 3 lc rgb '{}' {}", t ? ", " : "plot ", t,
                              color_of(tables[t], t), key_title(tables[t]));
    }
    const double step = nice_step(std::max(largest * 1.15, 0.01), 6), top = std::ceil(largest * 1.15 / step) * step;
    set_curve_axes(script,
                   title_or(request, fmt::format("Polarization in the plane of incidence ({:g} nm, light at {:g}°)",
                                                 request.wavelength_nm, request.theta_i_deg)),
                   has_labels(tables));
    script.line("set xrange [-90:90]; set xtics 30 format '%g°'; set mxtics 3")
        .line(fmt::format("set yrange [0:{:.6g}]; set ytics {:.6g}", std::clamp(top, step, 1.0), step))
        .line("set xlabel 'exit angle from the normal  (light side < 0 < mirror side)'")
        .line("set ylabel 'degree of linear polarization' offset -0.5,0")
        // Mark where the light comes from and where a mirror sends it.
        .line(fmt::format("set arrow from {0:g}, graph 0 to {0:g}, graph 1 nohead dt 3 lc rgb '#909090' lw 1.5",
                          -request.theta_i_deg))
        .line(fmt::format("set arrow from {0:g}, graph 0 to {0:g}, graph 1 nohead dt 3 lc rgb '#909090' lw 1.5",
                          request.theta_i_deg))
        .line(curves);
    return figure;
}

// Arcs and rays of the lobe's polar grid, with their labels.
void draw_polar_grid(GnuplotScript& script, double radius, double step) {
    std::vector<double> radii;
    for (double arc = step; arc < radius * 1.001; arc += step) {
        radii.push_back(arc);
        script.line(fmt::format("set label '{0:g}' at {0:.6g},{1:.6g} center font size13 textcolor rgb '#606060'", arc,
                                -0.045 * radius));
        script.line(fmt::format("set label '{0:g}' at {1:.6g},{2:.6g} center font size13 textcolor rgb '#606060'", arc,
                                -arc, -0.045 * radius));
    }
    write_arcs(script, "arcs", radii, 0, 180);
    for (int angle = -90; angle <= 90; angle += 15) {
        const double x = std::sin(radians(angle)), y = std::cos(radians(angle));
        script.line(fmt::format("set arrow from 0,0 to {:.6g},{:.6g} nohead lc rgb '{}' lw 1 back", radius * x,
                                radius * y, angle % 90 == 0 ? "#808080" : "#e2e2e2"));
        if (angle % 30 == 0 && std::abs(angle) < 90)
            script.line(fmt::format("set label '{}°' at {:.6g},{:.6g} center font size14 textcolor rgb '#404040'",
                                    std::abs(angle), 1.06 * radius * x, 1.06 * radius * y));
    }
}

// The beam comes in from the left; the mirror direction is dashed.
void draw_beam(GnuplotScript& script, double theta_i_deg, double radius) {
    const double x = std::sin(radians(theta_i_deg)), y = std::cos(radians(theta_i_deg));
    script.line(
        fmt::format("set arrow from {:.6g},{:.6g} to {:.6g},{:.6g} head filled size screen 0.016,18 lc rgb '#C08000' "
                    "lw 3 front",
                    -radius * x, radius * y, -0.72 * radius * x, 0.72 * radius * y));
    script.line(fmt::format("set arrow from {:.6g},{:.6g} to {:.6g},{:.6g} nohead dt 2 lc rgb '#C08000' lw 2", 0.0, 0.0,
                            radius * x, radius * y));
}

Figure lobe_figure(std::span<const PlottedTable> tables, const PlotRequest& request) {
    Figure figure;
    figure.size = {1100, 700, 16};
    GnuplotScript& script = figure.script;
    const bool single = tables.size() == 1;
    double largest = 0, largest_dolp = 0;
    std::string curves;
    for (std::size_t t = 0; t < tables.size(); ++t) {
        const InPlane plane = in_plane(*tables[t].table, request);
        script.begin_data(fmt::format("d{}", t));
        for (std::size_t k = 0; k < plane.theta_deg.size(); ++k) {
            const double f = plane.reflected[k][0], dolp = optics::degree_of_linear_polarization(plane.reflected[k]);
            script.line(fmt::format("{:.6g} {:.6g} {:.4f}", f * std::sin(radians(plane.theta_deg[k])),
                                    f * std::cos(radians(plane.theta_deg[k])), dolp));
            largest = std::max(largest, f);
            largest_dolp = std::max(largest_dolp, dolp);
        }
        script.end_data();
        const std::string color = color_of(tables[t], t);
        if (single)
            curves = fmt::format(
                "$d{0} using 1:2 with filledcurves xy=0,0 fc rgb '#f1f1f1' notitle, $d{0} using 1:2:3 "
                "with lines lw 7 lc palette {1}",
                t, key_title(tables[t]));
        else
            curves += fmt::format("{}$d{} using 1:2 with lines lw 3.5 lc rgb '{}' {}", t ? ", " : "", t, color,
                                  key_title(tables[t]));
    }

    // A half disc of one scale in both directions.
    if (!(largest > 0)) largest = 1;
    const double step = nice_step(largest, 4), radius = std::ceil(largest / step * 1.0001) * step;
    script
        .line(fmt::format("set label 100 {} at screen 0.5,0.95 center font size18",
                          title_or(request, fmt::format("BRDF in the plane of incidence ({:g} nm, light at {:g}°)",
                                                        request.wavelength_nm, request.theta_i_deg))))
        .line("unset border; unset tics; set size ratio -1; set lmargin at screen 0.02; set bmargin at screen 0.02")
        .line(fmt::format("set tmargin at screen 0.91; set rmargin at screen {}",
                          single ? 0.87 : 0.8))  // the scale of colours, or the key
        .line(fmt::format("set xrange [{0:.6g}:{1:.6g}]; set yrange [{2:.6g}:{3:.6g}]", -1.12 * radius, 1.12 * radius,
                          -0.17 * radius, 1.14 * radius));
    if (single && tables[0].label.empty())
        script.line("unset key");
    else
        script.line("set key at screen 0.985, screen 0.9 right top Left reverse samplen 2 spacing 1.3");
    draw_polar_grid(script, radius, step);
    script.line(fmt::format("set label 'BRDF f₀₀ [1/sr]' at 0,{:.6g} center font size14 textcolor rgb '#404040'",
                            -0.13 * radius));

    draw_beam(script, request.theta_i_deg, radius);
    if (single) {
        const double top = std::clamp(nice_step(largest_dolp, 1), 0.01, 1.0), color_step = nice_step(top, 5);
        script.line(sequential_palette)
            .line(fmt::format("set cbrange [0:{:.6g}]; set cbtics {:.6g} scale 0.5", top, color_step))
            .line("set cblabel 'degree of linear polarization' offset 0.5,0")
            .line("set colorbox user origin screen 0.875,0.16 size screen 0.02,0.66 noborder");
    }
    script.line("plot $arcs using 1:2 with lines lc rgb '#d0d0d0' lw 1 notitle, " + curves);
    return figure;
}

Figure spectrum_figure(std::span<const PlottedTable> tables, const PlotRequest& request) {
    Figure figure;
    GnuplotScript& script = figure.script;
    const double mu_i = std::cos(radians(request.theta_i_deg));
    double largest = 0, shortest = 1e300, longest = 0;
    std::string curves;
    for (std::size_t t = 0; t < tables.size(); ++t) {
        const MuellerTable& table = *tables[t].table;
        script.begin_data(fmt::format("d{}", t));
        for (double wavelength_nm : table.wavelengths_nm) {
            const double body = table.body_albedo(wavelength_nm, mu_i),
                         total = body + table.specular(wavelength_nm, mu_i)(0, 0);
            script.line(fmt::format("{:.6g} {:.6g} {:.6g}", wavelength_nm, body, total));
            largest = std::max({largest, body, tables.size() == 1 ? total : body});
        }
        script.end_data();
        shortest = std::min(shortest, table.wavelengths_nm.front());
        longest = std::max(longest, table.wavelengths_nm.back());
        const bool single = tables.size() == 1;
        curves += fmt::format("{}$d{} using 1:2 with {} lw 3 pt 7 lc rgb '{}' {}", t ? ", " : "plot ", t,
                              table.wavelengths_nm.size() < 25 ? "linespoints" : "lines", color_of(tables[t], t),
                              single ? "title 'body'" : key_title(tables[t]));
        if (single) curves += ", $d0 using 1:3 with lines lw 2 dt 2 lc rgb '#606060' title 'body + specular'";
    }
    set_curve_axes(script,
                   title_or(request, fmt::format("Directional-hemispherical reflectance ({}light at {:g}°)",
                                                 tables.size() == 1 ? "" : "body, ", request.theta_i_deg)),
                   tables.size() == 1 || has_labels(tables));
    if (longest - shortest < 20) {
        shortest -= 10;
        longest += 10;
    }
    const double step = nice_step(std::max(largest * 1.2, 1e-6), 6);
    script.line(fmt::format("set xrange [{:g}:{:g}]; set mxtics 2", shortest, longest))
        .line(
            fmt::format("set yrange [0:{:.6g}]; set ytics {:.6g}", std::ceil(largest * 1.2 / step + 1e-9) * step, step))
        .line("set xlabel 'wavelength [nm]'; set ylabel 'reflectance' offset -0.5,0")
        .line(curves);
    return figure;
}

Figure albedo_figure(std::span<const PlottedTable> tables, const PlotRequest& request) {
    Figure figure;
    GnuplotScript& script = figure.script;
    double largest = 0;
    std::string curves;
    for (std::size_t t = 0; t < tables.size(); ++t) {
        const MuellerTable& table = *tables[t].table;
        script.begin_data(fmt::format("d{}", t));
        for (int theta = 0; theta <= 89; ++theta) {
            const double mu_i = std::cos(radians(theta)), body = table.body_albedo(request.wavelength_nm, mu_i);
            const double specular = table.specular(request.wavelength_nm, mu_i)(0, 0);
            script.line(fmt::format("{} {:.6g} {:.6g} {:.6g}", theta, body, specular, body + specular));
            largest = std::max(largest, tables.size() == 1 ? body + specular : body);
        }
        script.end_data();
        if (tables.size() == 1)
            curves = fmt::format(
                "plot $d0 using 1:4 with lines lw 3 lc rgb '#303030' title 'total', $d0 using 1:2 with lines lw "
                "3 lc rgb '{}' title 'body', $d0 using 1:3 with lines lw 3 dt 2 lc rgb '{}' title 'specular'",
                color_of(tables[0], 0), curve_colors[1]);
        else
            curves += fmt::format("{}$d{} using 1:2 with lines lw 3 lc rgb '{}' {}", t ? ", " : "plot ", t,
                                  color_of(tables[t], t), key_title(tables[t]));
    }
    set_curve_axes(script,
                   title_or(request, fmt::format("Directional-hemispherical reflectance ({}{:g} nm)",
                                                 tables.size() == 1 ? "" : "body, ", request.wavelength_nm)),
                   tables.size() == 1 || has_labels(tables));
    const double step = nice_step(std::max(largest * 1.25, 1e-6), 6);
    script.line("set xrange [0:90]; set xtics 15 format '%g°'")
        .line(fmt::format("set yrange [0:{:.6g}]; set ytics {:.6g}", std::ceil(largest * 1.25 / step + 1e-9) * step,
                          step))
        .line("set xlabel 'angle of incidence'; set ylabel 'reflectance' offset -0.5,0")
        .line(curves);
    return figure;
}

}  // namespace

Figure curve_figure(std::span<const PlottedTable> tables, const PlotRequest& request) {
    switch (request.kind) {
        case PlotKind::dolp:
            return dolp_figure(tables, request);
        case PlotKind::spectrum:
            return spectrum_figure(tables, request);
        case PlotKind::albedo:
            return albedo_figure(tables, request);
        default:
            return lobe_figure(tables, request);
    }
}

}  // namespace patina::jobs
