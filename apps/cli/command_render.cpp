#include <charconv>

#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/jobs/render.h"

namespace patina::cli {

namespace {

struct Options {
    std::string scene, output, integrator, time, size, crop, sensor;
    std::vector<std::string> defines, light_paths;
    int samples = 0, neumann = 0;
    double noise = 0.0, checkpoint_every = 60.0;
    std::uint64_t seed = 0;
    bool stokes_rgb = false, png = true, resume = false, keep_checkpoint = false;
};

// "90", "90s", "5m", "1h" in seconds.
double parse_duration(const std::string& text) {
    double value = 0.0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::string unit(end, text.data() + text.size());
    const double factor = unit.empty() || unit == "s" ? 1.0 : unit == "m" ? 60.0 : unit == "h" ? 3600.0 : 0.0;
    if (status != std::errc{} || factor == 0.0 || !(value > 0.0))
        throw Error(ErrorKind::usage, fmt::format("--time {}: write 90s, 5m or 1h", text));
    return value * factor;
}

std::pair<int, int> parse_size(const std::string& text) {
    int width = 0, height = 0;
    char cross = 0, rest = 0;
    if (std::sscanf(text.c_str(), "%d%c%d%c", &width, &cross, &height, &rest) != 3 || cross != 'x' || width < 1 ||
        height < 1 || width > 65536 || height > 65536)
        throw Error(ErrorKind::usage, fmt::format("--size {}: write WIDTHxHEIGHT, as in 640x480", text));
    return {width, height};
}

std::array<int, 4> parse_crop(const std::string& text) {
    const std::vector<double> numbers = parse_number_list(text, "--crop");
    if (numbers.size() != 4) throw Error(ErrorKind::usage, "--crop takes four pixels x0,y0,x1,y1");
    std::array<int, 4> crop{};
    for (int i = 0; i < 4; ++i) {
        if (!(numbers[i] >= 0 && numbers[i] <= 65536))
            throw Error(ErrorKind::usage, "--crop takes four pixels x0,y0,x1,y1");
        crop[i] = static_cast<int>(numbers[i]);
    }
    return crop;
}

jobs::RenderRequest make_request(const Options& options, const CLI::App& command, const Session& session) {
    jobs::RenderRequest request;
    request.scene = options.scene;
    request.command = session.command_line;
    request.checkpoint = std::filesystem::path(options.output).replace_extension(".checkpoint");
    request.checkpoint_interval_s = options.checkpoint_every;
    request.outputs = {options.output};
    if (options.png) request.outputs.push_back(std::filesystem::path(options.output).replace_extension(".png"));
    request.keep_checkpoint = options.keep_checkpoint;
    request.resume = options.resume;
    request.sensor = options.sensor;
    for (const std::string& define : options.defines) {
        const size_t equals = define.find('=');
        if (equals == std::string::npos) throw Error(ErrorKind::usage, fmt::format("-D {}: write name=value", define));
        request.variables[define.substr(0, equals)] = define.substr(equals + 1);
    }
    if (options.samples > 0) request.options.samples_per_pixel = options.samples;
    if (!options.time.empty()) request.options.time_limit_seconds = parse_duration(options.time);
    if (options.noise > 0.0) request.options.noise_target = options.noise;
    if (!options.size.empty()) request.options.size = parse_size(options.size);
    if (!options.crop.empty()) request.options.crop = parse_crop(options.crop);
    if (!options.integrator.empty()) request.options.integrator = options.integrator;
    for (const std::string& output : options.light_paths) {
        const size_t equals = output.find('=');
        if (equals == std::string::npos)
            throw Error(ErrorKind::usage, fmt::format("--lpe {}: write name=EXPRESSION, as in direct=LDE", output));
        request.options.light_paths.push_back({output.substr(0, equals), output.substr(equals + 1)});
        jobs::part_path(options.output, request.options.light_paths.back().name);
    }
    request.options.neumann_terms = options.neumann;
    if (command.count("--seed")) request.options.seed = options.seed;
    return request;
}

// What a meter read, in words.
void print(const render::Measurement& m, Console& console) {
    const render::QuantityNames& names = render::names_of(m.quantity);
    const std::string error =
        m.standard_error > 0 ? fmt::format(" (standard error {:.2g})", m.standard_error) : std::string();
    console.result(fmt::format("{}: {:.6g} {} over 380 .. 780 nm", names.name, m.radiometric[0], names.unit));
    console.result(
        fmt::format("{}: {:.6g} {}{}", names.photometric_name, m.photometric[0], names.photometric_unit, error));
    if (m.radiometric[0] > 0)
        console.result(fmt::format("polarization (S1, S2, S3)/S0: {:.4f} {:.4f} {:.4f}",
                                   m.radiometric[1] / m.radiometric[0], m.radiometric[2] / m.radiometric[0],
                                   m.radiometric[3] / m.radiometric[0]));
    if (m.total_flux)
        console.result(fmt::format("flux into all directions: {:.6g} W, {:.6g} lm; largest {}: {:.6g} {}",
                                   (*m.total_flux)[0], (*m.total_flux)[1], names.photometric_name, m.peak,
                                   names.photometric_unit));
    if (m.exposure_s > 0)
        console.result(fmt::format("times the exposure of {:.6g} s: {:.6g} {} s, {:.6g} {} s", m.exposure_s,
                                   m.exposure_s * m.radiometric[0], names.unit, m.exposure_s * m.photometric[0],
                                   names.photometric_unit));
}

nlohmann::json to_json(const render::Measurement& m, const StokesImage& image) {
    const render::QuantityNames& names = render::names_of(m.quantity);
    nlohmann::json document = {{"quantity", names.name},
                               {"unit", names.unit},
                               {"value", m.radiometric[0]},
                               {"stokes", m.radiometric},
                               {"photometric_quantity", names.photometric_name},
                               {"photometric_unit", names.photometric_unit},
                               {"photometric_value", m.photometric[0]},
                               {"photometric_stokes", m.photometric},
                               {"photometric_standard_error", m.standard_error},
                               {"spectral_unit", names.spectral_unit},
                               {"bin_edges_nm", image.bin_edges_nm},
                               {"spectral_stokes", m.spectral}};
    if (m.total_flux) {
        document["flux_w"] = (*m.total_flux)[0];
        document["luminous_flux_lm"] = (*m.total_flux)[1];
        document["largest_photometric_value"] = m.peak;
    }
    if (m.exposure_s > 0) document["exposure_s"] = m.exposure_s;
    return document;
}

int run(const Options& options, const CLI::App& command, Session& session) {
    const jobs::RenderRequest request = make_request(options, command, session);
    jobs::check_picture_output(options.output);
    std::error_code ignored;
    const bool checkpoint_there = std::filesystem::exists(request.checkpoint, ignored);
    if (checkpoint_there && !options.resume)
        session.console.note(fmt::format("{} is there from a render that was stopped: --resume would go on with it",
                                         request.checkpoint.string()));
    if (!checkpoint_there && options.resume) session.console.note("there is no checkpoint: the render begins anew");
    const render::Pictures pictures = jobs::render_scene(request, session.control());
    const StokesImage& image = pictures.whole;
    std::vector<std::string> written = jobs::write_picture(options.output, image, options.stokes_rgb, options.png);
    for (const auto& [name, part] : pictures.parts)
        written.push_back(
            jobs::write_picture(jobs::part_path(options.output, name), part, options.stokes_rgb, false).front());

    Console& console = session.console;
    console.end_progress();
    const auto meta = [&](const char* key) {
        return image.metadata.count(key) ? image.metadata.at(key) : std::string();
    };
    for (const auto& [key, value] : image.metadata)
        if (key.starts_with("warning")) console.note("warning: " + value);
    console.result(fmt::format("{}: {} x {} pixels", options.output, image.width, image.height));
    for (size_t part = 0; part < pictures.parts.size(); ++part)
        console.result(fmt::format("{}: {}", written[written.size() - pictures.parts.size() + part],
                                   pictures.parts[part].second.metadata.at("light_paths")));
    if (!meta("neumann_norm").empty())
        console.result(fmt::format("norm of the transport operator, as seen here: {}", meta("neumann_norm")));
    if (pictures.measurement) print(*pictures.measurement, console);
    nlohmann::json document = {{"schema", "patina/render/1"},
                               {"written", written},
                               {"width", image.width},
                               {"height", image.height},
                               {"metadata", image.metadata}};
    if (pictures.measurement) document["measurement"] = to_json(*pictures.measurement, image);
    console.document(document);
    if (meta("stopped") == "yes") {
        console.note(
            "stopped early: the picture holds the samples that were done; the same command with --resume goes on");
        return static_cast<int>(ErrorKind::interrupted);
    }
    console.hint(fmt::format("patina image dolp {} -o dolp.png", options.output));
    return 0;
}

}  // namespace

void add_render(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand(
        "render", "render a Mitsuba 3 scene with full polarization into a spectral Stokes EXR (and a PNG beside it)");
    command->add_option("scene", options->scene, "scene (Mitsuba 3 XML)")->required();
    command->add_option("-o,--output", options->output, "picture to write (.exr)")->required();
    command->add_option("--integrator", options->integrator, "in place of the scene's");
    command->add_option("--sensor", options->sensor, "of a scene with several: its id, or its number from 0");
    command->add_option("--spp", options->samples, "samples per pixel")->check(CLI::Range(1, 1 << 24));
    command->add_option("--time", options->time, "stop after this time: 90s, 5m, 1h");
    command->add_option("--noise", options->noise, "stop at this relative noise, as in 0.01")
        ->check(CLI::Range(1e-6, 1.0));
    command->add_option("--size", options->size, "film size WIDTHxHEIGHT");
    command->add_option("--crop", options->crop, "window of pixels x0,y0,x1,y1");
    command->add_option("--seed", options->seed, "seed of the random numbers; the same seed gives the same bits");
    command->add_flag("--resume", options->resume,
                      "go on where a stopped render of the same picture was (OUT.checkpoint), to the same bits");
    command->add_option("--checkpoint-every", options->checkpoint_every, "seconds between checkpoints (default 60)")
        ->check(CLI::Range(0.01, 1e9));
    command->add_flag("--keep-checkpoint", options->keep_checkpoint,
                      "keep OUT.checkpoint when done, so that --resume can add samples");
    command->add_option("-D,--define", options->defines, "set a <default> of the scene: name=value (repeatable)")
        ->take_all()
        ->allow_extra_args(false);
    command
        ->add_option("--lpe", options->light_paths,
                     "also write the light of these paths to OUT.name.exr: name=EXPRESSION with L light, E eye, D "
                     "diffuse, G glossy, S specular, . any, ( ) | * + ?, as in caustics=LS+DE (repeatable)")
        ->take_all()
        ->allow_extra_args(false);
    command
        ->add_option("--neumann", options->neumann,
                     "also write the first K terms of the Neumann series, L_e, T L_e, ..., and the rest")
        ->check(CLI::Range(1, 100));
    command->add_flag("--stokes-rgb", options->stokes_rgb, "write Mitsuba's S0.R ... S3.B channels");
    command->add_flag("!--no-png", options->png, "do not write a PNG beside the EXR");
    command->footer("example: patina render examples/painted_spheres.xml -o spheres.exr --spp 64");
    command->callback([options, command, &session] {
        session.chosen = [options, command, &session] { return run(*options, *command, session); };
    });
}

}  // namespace patina::cli
