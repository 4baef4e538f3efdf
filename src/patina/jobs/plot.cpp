#include "patina/jobs/plot.h"

#include <algorithm>
#include <cmath>

#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/jobs/plot_style.h"

namespace patina::jobs {

namespace {

bool is_map(PlotKind kind) {
    return kind == PlotKind::polar || kind == PlotKind::mueller || kind == PlotKind::aolp;
}

void require_drawable(std::span<const PlottedTable> tables, const PlotRequest& request) {
    if (!(request.theta_i_deg >= 0 && request.theta_i_deg <= 89))
        throw Error(ErrorKind::usage,
                    fmt::format("the angle of incidence is {} deg; it must lie in 0 .. 89 deg", request.theta_i_deg));
    if (!(request.wavelength_nm > 0) || !std::isfinite(request.wavelength_nm))
        throw Error(ErrorKind::usage,
                    fmt::format("the wavelength is {} nm; it must be positive", request.wavelength_nm));
    const std::size_t most = is_map(request.kind) ? 1 : curve_colors.size();
    if (tables.empty() || tables.size() > most)
        throw Error(ErrorKind::usage,
                    fmt::format("a figure of this kind shows 1 .. {} tables, not {}", most, tables.size()));
}

}  // namespace

const std::vector<std::string>& plot_kind_names() {
    static const std::vector<std::string> names = {"lobe", "polar", "mueller", "dolp", "aolp", "spectrum", "albedo"};
    return names;
}

PlotKind plot_kind_named(std::string_view name) {
    const auto& names = plot_kind_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw Error(ErrorKind::usage, fmt::format("unknown kind of plot \"{}\"; {}", name, did_you_mean(name, names)));
    return static_cast<PlotKind>(found - names.begin());
}

double nice_step(double largest, int intervals) {
    const double raw = std::max(largest, 1e-300) / intervals, power = std::pow(10.0, std::floor(std::log10(raw)));
    for (double factor : {1.0, 2.0, 5.0})
        if (factor * power >= raw * (1 - 1e-9)) return factor * power;
    return 10 * power;
}

void plot(std::span<const PlottedTable> tables, const PlotRequest& request, const std::filesystem::path& path) {
    for (const PlottedTable& plotted : tables) PATINA_EXPECT(plotted.table != nullptr);
    require_drawable(tables, request);
    const Figure figure =
        is_map(request.kind) ? map_figure(*tables.front().table, request) : curve_figure(tables, request);
    draw_with_gnuplot(figure.script, figure.size, path);
}

void plot(const brdf::MuellerTable& table, const PlotRequest& request, const std::filesystem::path& path) {
    const PlottedTable single{&table, "", ""};
    plot(std::span(&single, 1), request, path);
}

}  // namespace patina::jobs
