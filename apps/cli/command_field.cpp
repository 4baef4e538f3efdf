#include "command.h"
#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/jobs/field.h"

namespace patina::cli {

namespace {

struct Options {
    std::string recipe, theta_o = "0:80:10", phi = "0,90,180", stokes = "1,0,0,0", tau;
    std::vector<std::string> settings;
    double theta_i = 0.0;
    double wavelength = 0.0;
    int streams = 0;
    std::string solver = "doubling";
    bool scalar = false;
    std::int64_t samples = 1'000'000;
    std::uint64_t seed = 1;
};

jobs::FieldJob make_job(const Options& options) {
    jobs::FieldJob job;
    job.theta_i_deg = options.theta_i;
    job.theta_o_deg = parse_number_list(options.theta_o, "--theta-o-deg");
    job.phi_deg = parse_number_list(options.phi, "--phi-deg");
    const std::vector<double> stokes = parse_number_list(options.stokes, "--stokes");
    if (stokes.size() != 4) throw Error(ErrorKind::usage, "--stokes takes four numbers I,Q,U,V");
    job.incident = {stokes[0], stokes[1], stokes[2], stokes[3]};
    if (!options.tau.empty()) job.optical_depths = parse_number_list(options.tau, "--tau");
    if (options.wavelength > 0.0) job.wavelength_nm = options.wavelength;
    job.streams = options.streams;
    job.solver = options.solver;
    job.scalar = options.scalar;
    job.samples = options.samples;
    job.seed = options.seed;
    return job;
}

nlohmann::json matrix_json(const optics::Mueller& m) {
    nlohmann::json rows = nlohmann::json::array();
    for (int i = 0; i < 4; ++i) rows.push_back({m(i, 0), m(i, 1), m(i, 2), m(i, 3)});
    return rows;
}

nlohmann::json to_json(const jobs::FieldJob& job, const jobs::FieldResult& result) {
    const nlohmann::json wavelength = job.wavelength_nm ? nlohmann::json(*job.wavelength_nm) : nlohmann::json(nullptr);
    nlohmann::json radiance = nlohmann::json::array();
    for (const jobs::FieldValue& value : result.radiance) {
        radiance.push_back({{"tau", value.optical_depth},
                            {"direction", value.upward ? "up" : "down"},
                            {"theta_deg", value.theta_deg},
                            {"phi_deg", value.phi_deg},
                            {"wavelength_nm", wavelength},
                            {"stokes", {value.stokes[0], value.stokes[1], value.stokes[2], value.stokes[3]}}});
        if (const auto& error = value.standard_error)
            radiance.back()["standard_error"] = {(*error)[0], (*error)[1], (*error)[2], (*error)[3]};
    }
    const bool finite = std::isfinite(result.optical_thickness);
    return {{"schema", "patina/field/1"},
            {"radiance", radiance},
            {"specular",
             {{"theta_deg", job.theta_i_deg},
              {"surface", matrix_json(result.specular_surface)},
              {"coherent", matrix_json(result.specular_coherent)}}},
            {"optical_thickness", finite ? nlohmann::json(result.optical_thickness) : nlohmann::json("inf")},
            {"solver", job.solver},
            {"streams", result.diagnostics.streams},
            {"fourier_orders", result.diagnostics.fourier_orders},
            {"converged", result.diagnostics.converged},
            {"notes", result.notes}};
}

int run(const Options& options, Session& session) {
    const coating::Recipe recipe = coating::read_recipe(options.recipe, options.settings);
    const jobs::FieldJob job = make_job(options);
    const jobs::FieldResult result = jobs::field(recipe, job, session.control());

    Console& console = session.console;
    console.end_progress();
    for (const std::string& note : result.notes) console.note("note: " + note);
    console.result("       tau  dir    theta      phi              I              Q              U              V");
    for (const jobs::FieldValue& v : result.radiance)
        console.result(fmt::format("{:10.5g} {:>4} {:8.3f} {:8.3f} {:14.7e} {:14.7e} {:14.7e} {:14.7e}",
                                   v.optical_depth, v.upward ? "up" : "down", v.theta_deg, v.phi_deg, v.stokes[0],
                                   v.stokes[1], v.stokes[2], v.stokes[3]) +
                       (v.standard_error
                            ? fmt::format("  +- {:.1e} {:.1e} {:.1e} {:.1e}", (*v.standard_error)[0],
                                          (*v.standard_error)[1], (*v.standard_error)[2], (*v.standard_error)[3])
                            : ""));
    console.document(to_json(job, result));
    return result.diagnostics.converged ? 0 : static_cast<int>(ErrorKind::check);
}

}  // namespace

void add_field(CLI::App& program, Session& session) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand(
        "field", "Stokes radiances at exact directions and depths, for a beam of flux pi through a plane normal to it");
    command->add_option("recipe", options->recipe, "paint recipe (TOML)")->required();
    command->add_option("--theta-i-deg", options->theta_i, "zenith angle of incidence")->required();
    command->add_option("--theta-o-deg", options->theta_o, "zenith angles of view, 0 to 90: 0,30,60 or 0:80:10")
        ->capture_default_str();
    command
        ->add_option("--phi-deg", options->phi,
                     "azimuths of view minus azimuth of the beam's propagation (0 = forward)")
        ->capture_default_str();
    command->add_option("--stokes", options->stokes, "Stokes vector of the beam I,Q,U,V (Q = I_par - I_perp)")
        ->capture_default_str();
    command->add_option("--tau", options->tau, "optical depths (default: top upward, bottom downward)");
    command->add_option("--wavelength-nm", options->wavelength, "vacuum wavelength")->check(CLI::PositiveNumber);
    command->add_option("--streams", options->streams, "quadrature nodes per hemisphere (default: chosen)");
    command->add_option("--solver", options->solver, "doubling | eigenmodes | montecarlo")->capture_default_str();
    command->add_option("--samples", options->samples, "montecarlo: photon packets")
        ->check(CLI::Range(1000LL, 1000000000000LL))
        ->capture_default_str();
    command->add_option("--seed", options->seed, "montecarlo: seed of the random numbers")->capture_default_str();
    command->add_option("--set", options->settings, "change a key of the recipe: layers.0.thickness_um=30 (repeatable)")
        ->take_all()
        ->allow_extra_args(false);
    command->add_flag("--scalar", options->scalar, "ignore polarization, to see what that costs");
    command->footer(
        "example: patina field examples/siewert_problem_IIA.toml --theta-i-deg 53.1301 --theta-o-deg 0,60 --phi-deg "
        "0,90,180 --tau 0,0.5,1 --json");
    command->callback([options, &session] { session.chosen = [options, &session] { return run(*options, session); }; });
}

}  // namespace patina::cli
