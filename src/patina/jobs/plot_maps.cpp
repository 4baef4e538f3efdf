// Figures over the exit hemisphere: polar, mueller, aolp.

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "patina/core/constants.h"
#include "patina/jobs/plot_style.h"

namespace patina::jobs {

using optics::Mueller;

namespace {

// Exit directions: the centre of the disc is the normal, the radius the exit angle, phi = 0 (mirror side) to the right.
struct Hemisphere {
    std::vector<double> theta_deg, phi_deg;
    brdf::MuellerGrid values;

    const Mueller& at(std::size_t theta, std::size_t phi) const {
        return values.at(static_cast<int>(theta), 0, static_cast<int>(phi));
    }
};

Hemisphere hemisphere(const brdf::MuellerTable& table, const PlotRequest& request, double step_deg) {
    Hemisphere result;
    std::vector<double> mu_o, phi;
    const int rings = static_cast<int>(std::lround(largest_exit_angle_deg / step_deg));
    for (int k = 0; k <= rings; ++k) result.theta_deg.push_back(largest_exit_angle_deg * k / rings);
    const int sectors = static_cast<int>(std::lround(360 / (2 * step_deg)));
    for (int k = 0; k <= sectors; ++k) result.phi_deg.push_back(360.0 * k / sectors);
    for (double angle : result.theta_deg) mu_o.push_back(std::cos(radians(angle)));
    for (double angle : result.phi_deg) phi.push_back(radians(angle));
    const double mu_i[] = {std::cos(radians(request.theta_i_deg))};
    result.values = table.evaluate_grid(request.wavelength_nm, mu_o, mu_i, phi);
    return result;
}

// Writes a block of data for pm3d: x, y and the value of every direction.
void write_disc(GnuplotScript& script, const std::string& name, const Hemisphere& sphere,
                const std::function<double(const Mueller&, double phi)>& value) {
    script.begin_data(name);
    for (std::size_t t = 0; t < sphere.theta_deg.size(); ++t) {
        for (std::size_t p = 0; p < sphere.phi_deg.size(); ++p) {
            const double phi = radians(sphere.phi_deg[p]), r = sphere.theta_deg[t];
            script.line(
                fmt::format("{:.5g} {:.5g} {:.5g}", r * std::cos(phi), r * std::sin(phi), value(sphere.at(t, p), phi)));
        }
        script.line("");
    }
    script.end_data();
}

double largest_of(const Hemisphere& sphere, const std::function<double(const Mueller&)>& value) {
    double largest = 0;
    for (const Mueller& mueller : sphere.values.values) largest = std::max(largest, value(mueller));
    return largest;
}

void set_disc_axes(GnuplotScript& script) {
    const double rim = largest_exit_angle_deg;
    script.line("set pm3d map interpolate smoothing,smoothing corners2color mean")
        .line("unset border; unset tics; unset key; set size ratio -1")
        .line(fmt::format("set xrange [{0:g}:{1:g}]; set yrange [{0:g}:{1:g}]", -1.06 * rim, 1.06 * rim))
        // Rings at 30 and 60 degrees and the rim.
        .line("set object 30 circle at 0,0 size first 30 fs empty border lc rgb '#60808080' lw 1 front")
        .line("set object 60 circle at 0,0 size first 60 fs empty border lc rgb '#60808080' lw 1 front")
        .line(fmt::format("set object 90 circle at 0,0 size first {:g} fs empty border lc rgb '#404040' lw 1.5 front",
                          rim));
}

// Where the light comes from (a sun: dot in a ring) and where a mirror would send it (a cross).
void mark_light(GnuplotScript& script, double theta_i_deg, double scale) {
    script
        .line(fmt::format("set label 1 '' at {:g},0 point pt 7 ps {:g} lc rgb '#E69F00' front", -theta_i_deg,
                          1.6 * scale))
        .line(
            fmt::format("set label 2 '' at {:g},0 point pt 6 ps {:g} lc rgb 'black' front", -theta_i_deg, 1.7 * scale))
        .line(fmt::format("set label 3 '' at {:g},0 point pt 2 ps {:g} lw {:g} lc rgb 'black' front", theta_i_deg,
                          1.4 * scale, 2 * scale));
}

std::string subtitle(const PlotRequest& request) {
    return fmt::format(
        "{:g} nm, light at {:g}° (● from the left; × mirror direction); disc: exit angle 0° … {:g}°, rings 30° and 60°",
        request.wavelength_nm, request.theta_i_deg, largest_exit_angle_deg);
}

void title_page(GnuplotScript& script, const PlotRequest& request, const std::string& made, double height, double gap) {
    const std::string title = request.title.empty() ? made : request.title;
    script.line(fmt::format("set label 100 {} at screen 0.5,{:g} center font ',20'", gnuplot_quoted(title), height))
        .line(fmt::format("set label 101 '{}' at screen 0.5,{:g} center font ',13' textcolor rgb '#505050'",
                          subtitle(request), height - gap));
}

double dolp(const Mueller& mueller) {
    return optics::degree_of_linear_polarization(mueller.col(0));
}

Figure polar_figure(const brdf::MuellerTable& table, const PlotRequest& request) {
    Figure figure;
    figure.size = {1500, 780, 16};
    GnuplotScript& script = figure.script;
    const Hemisphere sphere = hemisphere(table, request, 2.5);
    write_disc(script, "f", sphere, [](const Mueller& m, double) { return m(0, 0); });
    write_disc(script, "p", sphere, [](const Mueller& m, double) { return dolp(m); });
    const double largest = largest_of(sphere, [](const Mueller& m) { return m(0, 0); });
    const double polarized = std::clamp(largest_of(sphere, dolp), 1e-3, 1.0);

    script.line("set multiplot");
    set_disc_axes(script);
    script.line(sequential_palette);
    const auto panel = [&](const char* data, const char* label, double left, double top) {
        script
            .line(fmt::format(
                "set lmargin at screen {:g}; set rmargin at screen {:g}; set bmargin at screen 0.05; set tmargin "
                "at screen 0.84",
                left, left + 0.385))
            .line(fmt::format("set colorbox user origin screen {:g},0.12 size screen 0.014,0.64 noborder", left + 0.39))
            .line(fmt::format("set cbrange [0:{:.6g}]; set cbtics {:.6g} scale 0.5", top, nice_step(top, 6)))
            .line(fmt::format("set cblabel '{}' offset -0.3,0", label))
            .line(fmt::format("splot ${} using 1:2:3 with pm3d", data));
    };
    title_page(script, request, "Reflection over the exit hemisphere, unpolarized light", 0.95, 0.045);
    mark_light(script, request.theta_i_deg, 1.0);
    panel("f", "f₀₀ [1/sr]", 0.02, largest > 0 ? largest : 1.0);
    script.line("unset label 100; unset label 101");
    panel("p", "degree of linear polarization", 0.51, polarized);
    script.line("unset multiplot");
    return figure;
}

// The direction of vibration of E, seen from above, as short lines as long as the light is polarized: x, y, dx, dy.
void write_vibrations(GnuplotScript& script, const Hemisphere& sphere, double polarized) {
    script.begin_data("v");
    for (std::size_t t = 1; t + 1 < sphere.theta_deg.size(); ++t)
        for (std::size_t p = 0; p + 1 < sphere.phi_deg.size(); ++p) {
            const double phi = radians(sphere.phi_deg[p]), r = sphere.theta_deg[t];
            const optics::Stokes stokes = sphere.at(t, p).col(0);
            // p points to the normal in the picture's plane, s along rising azimuth.
            const double angle = 0.5 * std::atan2(stokes[2], stokes[1]),
                         length = 7.0 * dolp(sphere.at(t, p)) / polarized;
            const double inward = length * std::cos(angle), around = length * std::sin(angle);
            const double dx = -inward * std::cos(phi) - around * std::sin(phi);
            const double dy = -inward * std::sin(phi) + around * std::cos(phi);
            script.line(fmt::format("{:.5g} {:.5g} {:.5g} {:.5g}", r * std::cos(phi) - dx / 2,
                                    r * std::sin(phi) - dy / 2, dx, dy));
        }
    script.end_data();
}

Figure aolp_figure(const brdf::MuellerTable& table, const PlotRequest& request) {
    Figure figure;
    figure.size = {1000, 860, 16};
    GnuplotScript& script = figure.script;
    const Hemisphere sphere = hemisphere(table, request, 1.5);
    const double polarized = std::max(largest_of(sphere, dolp), 1e-12);
    write_vibrations(script, hemisphere(table, request, 10.6), polarized);

    // Hue: angle of E from the meridian plane, turning towards s. Unpolarized directions fade to white.
    script.begin_data("a");
    for (std::size_t t = 0; t < sphere.theta_deg.size(); ++t) {
        for (std::size_t p = 0; p < sphere.phi_deg.size(); ++p) {
            const double phi = radians(sphere.phi_deg[p]), r = sphere.theta_deg[t];
            const optics::Stokes stokes = sphere.at(t, p).col(0);
            double angle = degrees(0.5 * std::atan2(stokes[2], stokes[1]));
            if (angle < 0) angle += 180;
            script.line(fmt::format("{:.5g} {:.5g} {:.5g} {:.5g}", r * std::cos(phi), r * std::sin(phi), angle,
                                    std::min(1.0, std::sqrt(dolp(sphere.at(t, p)) / polarized))));
        }
        script.line("");
    }
    script.end_data();
    script.line("color(a, s) = hsv2rgb(a / 180.0, 0.85 * s, 0.95)");
    set_disc_axes(script);
    script.line("set multiplot").line("set palette model HSV functions gray, 0.85, 0.95").line("set cbrange [0:180]");
    title_page(script, request, "Angle of linear polarization, unpolarized light; lines: vibration of E", 0.955, 0.042);
    mark_light(script, request.theta_i_deg, 1.0);
    script
        .line(
            "set lmargin at screen 0.04; set rmargin at screen 0.8; set bmargin at screen 0.04; set tmargin at screen "
            "0.87")
        .line("set pm3d interpolate 1,1 corners2color c1")
        .line("unset colorbox")
        .line(
            "splot $a using 1:2:(0):(color($3, $4)) with pm3d lc rgb variable, $v using 1:2:(0):3:4:(0) with vectors "
            "nohead lw 2.2 "
            "lc rgb '#202020'")
        // A second, empty plot draws the scale of hues.
        .line("unset label; unset object; set colorbox user origin screen 0.84,0.14 size screen 0.024,0.6 noborder")
        .line("set cbtics 30 format '%g°' scale 0.5; set cblabel 'angle from the meridian plane' offset 0.5,0")
        .line("splot [0:1][0:1] NaN with pm3d lc palette")
        .line("unset multiplot");
    return figure;
}

Figure mueller_figure(const brdf::MuellerTable& table, const PlotRequest& request) {
    Figure figure;
    figure.size = {1300, 1330, 16};
    GnuplotScript& script = figure.script;
    const Hemisphere sphere = hemisphere(table, request, 3.75);
    double largest = 0;
    for (const Mueller& mueller : sphere.values.values)
        if (mueller(0, 0) > 0)
            for (int k = 1; k < 16; ++k) largest = std::max(largest, std::abs(mueller(k / 4, k % 4) / mueller(0, 0)));
    const double range = std::clamp(nice_step(std::min(largest, 1.0), 1), 1e-3, 1.0);
    for (int k = 0; k < 16; ++k)
        write_disc(script, fmt::format("m{}{}", k / 4, k % 4), sphere, [k](const Mueller& m, double) {
            return k == 0 ? m(0, 0) : m(0, 0) > 0 ? m(k / 4, k % 4) / m(0, 0) : 0.0;
        });

    script.line("set multiplot");
    set_disc_axes(script);
    title_page(script, request, "Mueller BRDF over the exit hemisphere", 0.975, 0.028);
    mark_light(script, request.theta_i_deg, 0.6);
    const double width = 0.205, height = 0.2, left = 0.03, top = 0.895;
    for (int k = 0; k < 16; ++k) {
        const double x = left + width * (k % 4), y = top - 0.222 * (k / 4);
        if (k == 1) script.line("unset label 100; unset label 101");
        script
            .line(fmt::format(
                "set lmargin at screen {:g}; set rmargin at screen {:g}; set tmargin at screen {:g}; set bmargin at "
                "screen {:g}",
                x, x + width * 0.97, y, y - height))
            .line(
                fmt::format("set label 4 '{}' at graph 0.0,0.97 left font ',15'", fmt::format("f{}{}", k / 4, k % 4)));
        // The first panel has a scale of its own, the other fifteen share one.
        if (k == 0) {
            const double brightest = largest_of(sphere, [](const Mueller& m) { return m(0, 0); });
            const double f = brightest > 0 ? brightest : 1.0;
            script.line(sequential_palette)
                .line(fmt::format("set cbrange [0:{:.6g}]; set cbtics {:.6g} scale 0.5", f, nice_step(f, 4)))
                .line("set cblabel 'f00 [1/sr]' offset 0.3,0")
                .line(fmt::format("set colorbox user origin screen 0.875,{:g} size screen 0.018,{:g} noborder",
                                  top - height, height * 0.95));
        } else if (k == 1) {
            script.line(diverging_palette)
                .line(fmt::format("set cbrange [{0:.6g}:{1:.6g}]; set cbtics {2:.6g} scale 0.5", -range, range,
                                  nice_step(2 * range, 8)))
                .line("set cblabel 'element / f00' offset 0.3,0")
                .line("set colorbox user origin screen 0.875,0.06 size screen 0.018,0.5 noborder");
        } else if (k == 2) {
            script.line("unset colorbox");
        }
        script.line(fmt::format("splot $m{}{} using 1:2:3 with pm3d", k / 4, k % 4));
    }
    script.line("unset multiplot");
    return figure;
}

}  // namespace

Figure map_figure(const brdf::MuellerTable& table, const PlotRequest& request) {
    switch (request.kind) {
        case PlotKind::mueller:
            return mueller_figure(table, request);
        case PlotKind::aolp:
            return aolp_figure(table, request);
        default:
            return polar_figure(table, request);
    }
}

}  // namespace patina::jobs
