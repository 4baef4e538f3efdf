#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/io/image_compare.h"
#include "patina/io/stokes_exr.h"
#include "patina/io/table_hdf5.h"
#include "patina/jobs/compare.h"

namespace patina::cli {

namespace {

using nlohmann::json;

struct Options {
    std::string a, b, wavelengths;
    double tolerance = 1e-3;
};

json to_json(const jobs::Difference& d) {
    return {{"rms", d.root_mean_square}, {"max", d.largest}};
}

json to_json(const io::ComponentDifference& d) {
    return {{"rms", d.root_mean_square}, {"mean", d.mean},       {"mean_absolute", d.mean_absolute},
            {"max", d.largest},          {"max_x", d.largest_x}, {"max_y", d.largest_y}};
}

json document_of(const Options& options, const char* kind) {
    return {{"schema", "patina/compare/1"}, {"a", options.a}, {"b", options.b}, {"kind", kind}};
}

void compare_two_tables(const Options& options, const Console& console) {
    const std::vector<jobs::TableDifference> rows =
        jobs::compare_tables(io::read_table_hdf5(options.a), io::read_table_hdf5(options.b));
    json document = document_of(options, "tables");
    document["wavelengths"] = json::array();
    console.result("body BRDF, both angles up to 80 deg; B - A: root mean square / largest");
    console.result("      nm   mean f00           f00 (1/sr)          m_ij/m_00               DoLP             albedo");
    for (const jobs::TableDifference& row : rows) {
        json mueller = json::array();
        jobs::Difference worst;
        for (const auto& line : row.mueller) {
            json elements = json::array();
            for (const jobs::Difference& element : line) {
                elements.push_back(to_json(element));
                worst.root_mean_square = std::max(worst.root_mean_square, element.root_mean_square);
                worst.largest = std::max(worst.largest, element.largest);
            }
            mueller.push_back(elements);
        }
        document["wavelengths"].push_back({{"wavelength_nm", row.wavelength_nm},
                                           {"mean_f00", row.mean_f00},
                                           {"f00", to_json(row.f00)},
                                           {"mueller", mueller},
                                           {"dolp", to_json(row.dolp)},
                                           {"albedo", to_json(row.albedo)}});
        const auto pair = [](const jobs::Difference& d) {
            return fmt::format("{:8.2e} / {:8.2e}", d.root_mean_square, d.largest);
        };
        console.result(fmt::format("{:8.1f} {:10.4e}  {}  {}  {}  {}", row.wavelength_nm, row.mean_f00, pair(row.f00),
                                   pair(worst), pair(row.dolp), pair(row.albedo)));
    }
    console.document(document);
}

void compare_two_images(const Options& options, const Console& console) {
    const io::ImageDifference difference =
        io::compare_images(io::read_stokes_exr(options.a), io::read_stokes_exr(options.b));
    json document = document_of(options, "images");
    document["bands"] = difference.bands;
    document["not_finite"] = difference.not_finite;
    document["stokes"] = json::array();
    document["rgb"] = json::array();
    console.result(fmt::format("A - B over all pixels and the {} bands; {} values that are not numbers are left out",
                               difference.bands, difference.not_finite));
    console.result("         rms        mean    mean abs     largest  at x, y    | rms in linear sRGB: R, G, B");
    for (int s = 0; s < 4; ++s) {
        const io::ComponentDifference& d = difference.stokes[s];
        const auto& [red, green, blue] = difference.rgb[s];
        json row = to_json(d);
        row["component"] = fmt::format("S{}", s);
        document["stokes"].push_back(row);
        document["rgb"].push_back(
            {{"component", fmt::format("S{}", s)}, {"R", to_json(red)}, {"G", to_json(green)}, {"B", to_json(blue)}});
        console.result(fmt::format("  S{} {:9.3e} {:11.3e} {:11.3e} {:11.3e}  {:>10} | {:9.3e} {:9.3e} {:9.3e}", s,
                                   d.root_mean_square, d.mean, d.mean_absolute, d.largest,
                                   fmt::format("{}, {}", d.largest_x, d.largest_y), red.root_mean_square,
                                   green.root_mean_square, blue.root_mean_square));
    }
    console.document(document);
}

void compare_two_recipes(const Options& options, Session& session) {
    const coating::Recipe a = coating::read_recipe(options.a), b = coating::read_recipe(options.b);
    jobs::PaintRequest request;
    request.angular = false;
    request.options.stack.tolerance = options.tolerance;
    if (!options.wavelengths.empty())
        request.options.stack.wavelengths_nm = parse_number_list(options.wavelengths, "--wavelengths");
    const jobs::PaintReport report_a = jobs::paint(a, request, session.control()),
                            report_b = jobs::paint(b, request, session.control());

    Console& console = session.console;
    console.end_progress();
    json document = document_of(options, "recipes");
    document["colours"] = json::array();
    console.result("over the own base                    L*      a*      b*  |     L*      a*      b*  | CIEDE2000");
    for (const jobs::ColourDifference& row : jobs::compare_colours(report_a.metrics, report_b.metrics)) {
        document["colours"].push_back({{"geometry", row.geometry},
                                       {"illuminant", row.illuminant},
                                       {"observer_deg", row.observer_deg},
                                       {"lab_a", {row.lab_a[0], row.lab_a[1], row.lab_a[2]}},
                                       {"lab_b", {row.lab_b[0], row.lab_b[1], row.lab_b[2]}},
                                       {"delta_e_2000", row.delta_e_2000}});
        console.result(
            fmt::format("  {:<13} {:<4} {:>2} deg     {:7.2f} {:7.2f} {:7.2f}  |{:7.2f} {:7.2f} {:7.2f}  | {:8.3f}",
                        row.geometry, row.illuminant, row.observer_deg, row.lab_a[0], row.lab_a[1], row.lab_a[2],
                        row.lab_b[0], row.lab_b[1], row.lab_b[2], row.delta_e_2000));
    }
    const auto optional = [](const std::optional<double>& value) { return value ? json(*value) : json(nullptr); };
    document["contrast_ratio"] = {report_a.metrics.contrast.r45_0, report_b.metrics.contrast.r45_0};
    document["hiding_power_m2_per_l"] = {optional(report_a.metrics.hiding.spreading_rate_m2_per_l),
                                         optional(report_b.metrics.hiding.spreading_rate_m2_per_l)};
    console.result(fmt::format("contrast ratio (45:0, D65, 10 deg, white {:g}): {:.4f} and {:.4f}",
                               report_a.metrics.white_reflectance, report_a.metrics.contrast.r45_0,
                               report_b.metrics.contrast.r45_0));
    console.document(document);
}

int run(const Options& options, Session& session) {
    const auto both = [&](const char* ending) { return options.a.ends_with(ending) && options.b.ends_with(ending); };
    if (both(".h5"))
        compare_two_tables(options, session.console);
    else if (both(".exr"))
        compare_two_images(options, session.console);
    else if (both(".toml"))
        compare_two_recipes(options, session);
    else
        throw Error(
            ErrorKind::usage,
            fmt::format(
                "patina compare takes two tables (.h5), two pictures (.exr) or two recipes (.toml), not {} and {}",
                options.a, options.b));
    return 0;
}

}  // namespace

void add_compare(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand("compare", "how two tables, pictures or recipes differ");
    command->add_option("a", options->a, "table (.h5), picture (.exr) or recipe (.toml)")->required();
    command->add_option("b", options->b, "another of the same kind")->required();
    command->add_option("--wavelengths", options->wavelengths,
                        "of recipes: vacuum wavelengths in nm (default: 400:700:10)");
    command->add_option("--tolerance", options->tolerance, "of recipes: relative accuracy wanted")
        ->check(CLI::Range(1e-8, 0.1))
        ->capture_default_str();
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
