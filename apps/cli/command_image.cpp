#include <optional>

#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/io/bitmap_file.h"
#include "patina/io/image_compare.h"
#include "patina/io/image_legend.h"
#include "patina/io/image_mosaic.h"
#include "patina/io/image_optics.h"
#include "patina/io/image_tone.h"
#include "patina/io/image_views.h"
#include "patina/io/png_file.h"
#include "patina/io/stokes_exr.h"

namespace patina::cli {

namespace {

struct Options {
    std::string operation, input, second, output, style = "dark", map = "grey", white_balance = "auto";
    double wavelength = 0.0, angle = 0.0, retardance = -1.0, exposure = 0.0, range = 0.0;
    std::optional<int> component;
    io::SensorNoise sensor;
    bool noise = false;
    bool normalized = false, manual_exposure = false, no_tone_curve = false, no_legend = false;
};

// What an operation makes: a picture for the screen, or another Stokes picture.
using Product = std::variant<Bitmap, StokesImage>;

io::StokesPlane plane_of(const StokesImage& image, const Options& options) {
    io::BandChoice choice;
    if (options.wavelength > 0.0) choice.wavelength_nm = options.wavelength;
    return io::select_band(image, choice);
}

// A view with what its colours mean beside it, unless the pixels alone are asked for.
Bitmap explained(const Bitmap& view, const io::Legend& legend, const Options& options) {
    return options.no_legend ? view : io::with_legend(view, legend);
}

io::ColorMap map_named(const std::string& name) {
    return name == "viridis" ? io::ColorMap::viridis : name == "inferno" ? io::ColorMap::inferno : io::ColorMap::grey;
}

Product stokes_view(const StokesImage& image, const Options& options) {
    const float range = static_cast<float>(options.range);
    const int component = options.component.value_or(1);
    float used = 0.0f;
    const Bitmap view = io::stokes_view(plane_of(image, options), component, options.normalized, range, used);
    const bool intensity = component == 0;
    return explained(
        view,
        io::bar_legend(fmt::format("S{}{}", component, options.normalized ? "/S0" : ""),
                       intensity ? io::ColorMap::inferno : io::ColorMap::diverging, intensity ? 0.0f : -used, used),
        options);
}

Product dolp_view(const StokesImage& image, const Options& options) {
    const io::ColorMap map = map_named(options.map);
    return explained(io::dolp_view(plane_of(image, options), map), io::bar_legend("DoLP", map, 0.0f, 1.0f), options);
}

Product aolp_view(const StokesImage& image, const Options& options) {
    const io::AolpStyle style = options.style == "full"    ? io::AolpStyle::full
                                : options.style == "light" ? io::AolpStyle::light
                                                           : io::AolpStyle::dark;
    return explained(io::aolp_view(plane_of(image, options), style), io::aolp_legend(style), options);
}

Product docp_view(const StokesImage& image, const Options& options) {
    return explained(io::docp_view(plane_of(image, options)), io::docp_legend(), options);
}

Product type_view(const StokesImage& image, const Options& options) {
    return explained(io::type_view(plane_of(image, options)), io::type_legend(), options);
}

Product chirality_view(const StokesImage& image, const Options& options) {
    return explained(io::chirality_view(plane_of(image, options)), io::chirality_legend(), options);
}

// Shares of S0 with their scale.
Product share_view(const StokesImage& image, const std::vector<float>& shares, const std::string& title,
                   const Options& options) {
    float used = 0.0f;
    const Bitmap view = io::share_view(image, shares, static_cast<float>(options.range), used);
    return explained(view, io::bar_legend(title, io::ColorMap::inferno, 0.0f, used), options);
}

Product noise_view(const StokesImage& image, const Options& options) {
    const int component = options.component.value_or(0);
    return share_view(image, io::relative_noise(image, component), fmt::format("noise S{}/S0", component), options);
}

Product mosaic(const StokesImage& image, const Options& options) {
    const Bitmap frame = io::polarization_mosaic(plane_of(image, options));
    return options.noise ? io::add_sensor_noise(frame, options.sensor) : frame;
}

Product tonemap(const StokesImage& image, const Options& options) {
    io::ToneOptions tone;
    tone.exposure_ev = options.exposure;
    tone.automatic_exposure = !options.manual_exposure;
    tone.tone_curve = !options.no_tone_curve;
    tone.white_balance = options.white_balance == "none"           ? io::WhiteBalance::none
                         : options.white_balance == "grey-world"   ? io::WhiteBalance::grey_world
                         : options.white_balance == "equal-energy" ? io::WhiteBalance::equal_energy
                                                                   : io::WhiteBalance::automatic;
    return io::tone_map(image, tone);
}

// The elements in front of the camera: a polarizer at --angle, or a retarder with its fast axis there.
Product through_element(const StokesImage& image, const Options& options) {
    const Eigen::Matrix4d element =
        options.operation == "polarizer"
            ? io::polarizer_mueller(options.angle)
            : io::retarder_mueller(options.angle, options.retardance < 0 ? 90.0 : options.retardance);
    return io::apply_mueller(image, element);
}

struct Operation {
    std::string name, summary;
    Product (*make)(const StokesImage&, const Options&);
};

const std::vector<Operation>& operations() {
    static const std::vector<Operation> list{
        {"tonemap", "colour as a screen shows it", tonemap},
        {"dolp", "degree of linear polarization, 0 to 1", dolp_view},
        {"aolp", "angle of linear polarization as hue over 180 degrees", aolp_view},
        {"docp", "degree of circular polarization, left blue, right red", docp_view},
        {"type", "linear cyan, circular yellow (Wilkie & Weidlich 2010)", type_view},
        {"chirality", "right blue, left yellow (Wilkie & Weidlich 2010)", chirality_view},
        {"stokes", "one component (--component) on a diverging map", stokes_view},
        {"polarizer", "through a linear polarizer at --angle-deg", through_element},
        {"waveplate", "through a retarder, fast axis at --angle-deg", through_element},
        {"noise", "standard error that the picture states of a component, over S0", noise_view},
        {"mosaic", "what a polarization camera's sensor sees (90 45 / 135 0)", mosaic},
    };
    return list;
}

std::vector<std::string> operation_names() {
    std::vector<std::string> names{"info", "diff", "error", "demosaic"};
    for (const Operation& operation : operations()) names.push_back(operation.name);
    return names;
}

void write(const Product& product, const std::string& output) {
    const bool exr = std::filesystem::path(output).extension() == ".exr";
    if (const StokesImage* image = std::get_if<StokesImage>(&product)) {
        // Without bins the colours are all that holds the polarization.
        io::StokesExrOptions channels;
        channels.stokes_rgb = image->bin_count() == 0;
        if (exr) return io::write_stokes_exr(output, *image, channels);
        return io::write_png(output, io::tone_map(*image));
    }
    const Bitmap& picture = std::get<Bitmap>(product);
    const bool frame = picture.channels == std::vector<std::string>{"Y"};
    if (exr && frame) return io::write_exr_bitmap(output, picture);
    if (exr)
        throw Error(ErrorKind::usage,
                    fmt::format("-o {}: this operation makes a picture for the screen; name it .png", output));
    if (!frame) return io::write_png(output, picture);
    // A frame is data: linear, full scale where the well of an automatically exposed sensor is full.
    Bitmap scaled = picture;
    const float white = static_cast<float>(io::automatic_white(picture));
    for (float& value : scaled.data) value /= white;
    io::write_png(output, scaled, {.bits = 16, .raw = true, .text = {}});
}

int info(const Options& options, Session& session) {
    const StokesImage image = io::read_stokes_exr(options.input);
    const io::ImageSummary summary = io::summarize_image(image);
    Console& console = session.console;
    console.result(fmt::format("{}: {} x {} pixels, {} spectral bins", options.input, image.width, image.height,
                               image.bin_count()));
    for (int s = 0; s < 4; ++s)
        console.result(fmt::format("S{}: mean {:.6g}, from {:.6g} to {:.6g}", s, summary.mean[s], summary.smallest[s],
                                   summary.largest[s]));
    console.result(fmt::format("DoLP: mean {:.4f}, largest {:.4f}; {} pixels over-polarized, {} not finite",
                               summary.mean_dolp, summary.largest_dolp, summary.over_polarized, summary.not_finite));
    console.document({{"schema", "patina/image-info/1"},
                      {"width", image.width},
                      {"height", image.height},
                      {"bins", image.bin_count()},
                      {"mean", summary.mean},
                      {"smallest", summary.smallest},
                      {"largest", summary.largest},
                      {"mean_dolp", summary.mean_dolp},
                      {"largest_dolp", summary.largest_dolp},
                      {"not_finite", summary.not_finite},
                      {"metadata", image.metadata}});
    return 0;
}

// |A - B| over S0 of B, the reference.
int error(const Options& options, Session& session) {
    if (options.second.empty() || options.output.empty())
        throw Error(ErrorKind::usage, "patina image error takes a picture, a reference and -o OUT.png");
    expect_writable(options.output);
    const StokesImage a = io::read_stokes_exr(options.input), b = io::read_stokes_exr(options.second);
    const int component = options.component.value_or(0);
    const std::vector<float> shares = io::relative_errors(a, b, component);
    write(share_view(b, shares, fmt::format("error S{}/S0", component), options), options.output);
    double mean = 0;
    for (const float share : shares) mean += share / static_cast<double>(shares.size());
    session.console.result(fmt::format("{}: mean relative error {:.4g}", options.output, mean));
    session.console.document({{"schema", "patina/image-error/1"}, {"written", options.output}, {"mean", mean}});
    return 0;
}

// A frame of a polarization camera, .exr or .png, as a Stokes picture.
int demosaic(const Options& options, Session& session) {
    if (options.output.empty()) throw Error(ErrorKind::usage, "patina image demosaic needs -o OUT");
    expect_writable(options.output);
    const StokesImage image = io::demosaic(io::read_bitmap(options.input, true));
    write(image, options.output);
    session.console.result(options.output);
    session.console.document(
        {{"schema", "patina/image/1"}, {"written", options.output}, {"operation", options.operation}});
    return 0;
}

int diff(const Options& options, Session& session) {
    if (options.second.empty()) throw Error(ErrorKind::usage, "patina image diff takes two pictures");
    const StokesImage a = io::read_stokes_exr(options.input), b = io::read_stokes_exr(options.second);
    const io::ImageDifference difference = io::compare_images(a, b);
    nlohmann::json rows = nlohmann::json::array();
    for (int s = 0; s < 4; ++s) {
        const io::ComponentDifference& d = difference.stokes[s];
        session.console.result(fmt::format("S{}: rms {:.6g}, mean {:.6g}, largest {:.6g} at ({}, {})", s,
                                           d.root_mean_square, d.mean, d.largest, d.largest_x, d.largest_y));
        rows.push_back({{"rms", d.root_mean_square},
                        {"mean", d.mean},
                        {"mean_absolute", d.mean_absolute},
                        {"largest", d.largest}});
    }
    session.console.document({{"schema", "patina/image-diff/1"},
                              {"bands", difference.bands},
                              {"stokes", rows},
                              {"not_finite", difference.not_finite}});
    if (!options.output.empty())
        write(std::filesystem::path(options.output).extension() == ".exr"
                  ? Product(io::subtract_images(a, b))
                  : stokes_view(io::subtract_images(a, b), options),
              options.output);
    return 0;
}

int run(const Options& options, Session& session) {
    if (options.operation == "info") return info(options, session);
    if (options.operation == "diff") return diff(options, session);
    if (options.operation == "error") return error(options, session);
    if (options.operation == "demosaic") return demosaic(options, session);
    const auto found = std::find_if(operations().begin(), operations().end(),
                                    [&](const Operation& operation) { return operation.name == options.operation; });
    if (found == operations().end())
        throw Error(ErrorKind::usage, fmt::format("unknown operation \"{}\" {}", options.operation,
                                                  did_you_mean(options.operation, operation_names())));
    if (!options.second.empty())
        throw Error(ErrorKind::usage, fmt::format("patina image {} takes one picture", options.operation));
    if (options.output.empty())
        throw Error(ErrorKind::usage, fmt::format("patina image {} needs -o OUT", options.operation));
    expect_writable(options.output);
    write(found->make(io::read_stokes_exr(options.input), options), options.output);
    session.console.result(options.output);
    session.console.document(
        {{"schema", "patina/image/1"}, {"written", options.output}, {"operation", options.operation}});
    return 0;
}

// The noise of `mosaic`; each option switches it on.
void add_sensor_options(CLI::App& command, Options& options) {
    const auto number = [&](const char* name, auto& target, const char* help) {
        using Value = std::decay_t<decltype(target)>;
        command.add_option_function<Value>(
            name,
            [&](const Value& value) {
                target = value;
                options.noise = true;
            },
            help);
    };
    number("--full-well-e", options.sensor.full_well_e, "mosaic: electrons a pixel holds (default 10500)");
    number("--read-noise-e", options.sensor.read_noise_e, "mosaic: read noise in electrons (default 2.4)");
    number("--bits", options.sensor.bits, "mosaic: bits of the digital numbers (default 12)");
    number("--black-level", options.sensor.black_level_dn, "mosaic: digital number of no light (default 0)");
    number("--white", options.sensor.white,
           "mosaic: light behind the analyser that fills the well (default: automatic)");
    number("--seed", options.sensor.seed, "mosaic: seed of the noise (default 0)");
}

}  // namespace

void add_image(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        program.add_subcommand("image", "pictures of polarization from a Stokes EXR, ours or Mitsuba's");
    std::string help =
        "operation:\n  info        sizes, ranges and provenance\n  diff        A - B with its metrics\n"
        "  error       |A - B| of a component over S0 of B\n"
        "  demosaic    Stokes picture from a polarization camera's frame\n";
    for (const Operation& operation : operations())
        help += fmt::format("  {:<11} {}\n", operation.name, operation.summary);
    command->add_option("operation", options->operation, help)->required();
    command->add_option("input", options->input, "Stokes EXR")->required();
    command->add_option("second", options->second, "second picture, for diff and error");
    command->add_option("-o,--output", options->output,
                        "picture to write (.png, or .exr for polarizer, waveplate, diff, mosaic, demosaic)");
    command->add_option("--wavelength-nm", options->wavelength, "one spectral bin (default: luminance)")
        ->check(CLI::PositiveNumber);
    command->add_option("--angle-deg", options->angle,
                        "angle of a polarizer or fast axis, counter-clockwise from horizontal");
    command->add_option("--retardance-deg", options->retardance, "retardance of the wave plate (default 90)")
        ->check(CLI::Range(0.0, 360.0));
    command->add_option("--component", options->component, "stokes, diff (default 1), error, noise (default 0)")
        ->check(CLI::Range(0, 3));
    command->add_flag("--normalized", options->normalized, "stokes: divided by S0");
    command
        ->add_option("--range", options->range,
                     "stokes, error, noise: end of the colour map (default: 99.5th percentile)")
        ->check(CLI::NonNegativeNumber);
    command->add_flag("--no-legend", options->no_legend, "views: the pixels alone, without what their colours mean");
    command->add_option("--map", options->map, "dolp: grey | viridis | inferno")
        ->check(CLI::IsMember({"grey", "viridis", "inferno"}));
    command->add_option("--style", options->style, "aolp: dark | light | full")
        ->check(CLI::IsMember({"dark", "light", "full"}));
    command->add_option("--exposure-ev", options->exposure, "tonemap: exposure in stops, on top of the automatic one");
    command->add_flag("--manual-exposure", options->manual_exposure, "tonemap: no automatic exposure");
    command->add_option("--white-balance", options->white_balance, "tonemap: auto | equal-energy | grey-world | none")
        ->check(CLI::IsMember({"auto", "equal-energy", "grey-world", "none"}));
    command->add_flag("--no-tone-curve", options->no_tone_curve, "tonemap: clip instead of rolling off");
    add_sensor_options(*command, *options);
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
