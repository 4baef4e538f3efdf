// The command line of Patina: a thin skin over patina/jobs. The one place where exceptions become exit codes.

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "command.h"
#include <unistd.h>

#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/core/memory.h"
#include "patina/core/parallel.h"
#include "patina/version.h"

namespace {

using namespace patina;

// The only state a signal handler may touch.
CancelToken* running = nullptr;

extern "C" void on_interrupt(int) {
    if (running->stop_requested()) ::_exit(static_cast<int>(ErrorKind::interrupted));
    running->request_stop();
    constexpr char message[] = "\nstopping; what is done will be kept (Ctrl-C again stops at once)\n";
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, message, sizeof message - 1);
}

void add_global_options(CLI::App& program, cli::Session& session) {
    program
        .add_option_function<int>(
            "-j,--threads", [](int count) { set_thread_count(count); }, "threads (default: all processors)")
        ->check(CLI::Range(0, 4096));
    program.add_flag("-q,--quiet", session.console.quiet, "say only what is asked for, and errors");
    program.add_flag("-v,--verbose", session.console.verbosity, "say more");
    program.add_flag("--json", session.console.json, "exactly one JSON document on stdout");
    program.add_option("--progress", session.console.progress_style, "how to show progress")
        ->option_text("auto|bar|plain|json|none")
        ->transform(
            CLI::CheckedTransformer(std::map<std::string, cli::ProgressStyle>{{"auto", cli::ProgressStyle::automatic},
                                                                              {"bar", cli::ProgressStyle::bar},
                                                                              {"plain", cli::ProgressStyle::plain},
                                                                              {"json", cli::ProgressStyle::json},
                                                                              {"none", cli::ProgressStyle::none}}));
    program.add_option("--color", session.console.color, "colour in the terminal (NO_COLOR is honoured)")
        ->option_text("auto|always|never")
        ->check(CLI::IsMember({"auto", "always", "never"}));
    program.set_version_flag("--version", std::string("patina ") + PATINA_VERSION);
}

// "unknown command "slove"; did you mean "solve"?" instead of CLI11's list of surplus arguments.
std::string explain(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv) {
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word.starts_with("-")) continue;
        if (std::find(names.begin(), names.end(), word) != names.end()) break;
        return "unknown command \"" + word + "\"; " + did_you_mean(word, names);
    }
    return error.what();
}

// What was asked for did not arrive. Who closed the pipe, as `head` does, knows.
int output_lost(int why) {
    if (why != EPIPE) std::fprintf(stderr, "error: the standard output cannot be written (%s)\n", std::strerror(why));
    return static_cast<int>(ErrorKind::runtime);
}

int run(int argc, char** argv) {
    cli::Session session;
    running = &session.cancel;
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
    std::signal(SIGPIPE, SIG_IGN);
    for (int i = 0; i < argc; ++i) session.command_line += (i ? " " : "") + std::string(i ? argv[i] : "patina");

    CLI::App program{
        "Patina computes how painted and coated materials look, polarization included, from what they are made of."};
    program.name("patina");
    program.require_subcommand(1);
    program.fallthrough();
    program.footer("Each command explains itself: patina solve --help");
    add_global_options(program, session);
    cli::add_solve(program, session);
    cli::add_field(program, session);
    cli::add_scattering(program, session);
    cli::add_render(program, session);
    cli::add_plot(program, session);
    cli::add_image(program, session);
    cli::add_inspect(program, session);
    cli::add_paint(program, session);
    cli::add_sweep(program, session);
    cli::add_compare(program, session);
    cli::add_check(program, session);
    cli::add_materials(program, session);
    cli::add_plugins(program, session);
    cli::add_new(program, session);
    cli::add_convert(program, session);
    cli::add_validate(program, session);

    try {
        program.parse(argc, argv);
        const int code = session.chosen();
        session.console.end_progress();
        return code;
    } catch (const CLI::Success& help) {
        return program.exit(help);
    } catch (const CLI::ParseError& error) {
        session.console.error(explain(program, error, argc, argv));
        session.console.note("see: patina --help");
        return static_cast<int>(ErrorKind::usage);
    } catch (const Error& error) {
        session.console.end_progress();
        session.console.error(error.what());
        return static_cast<int>(error.kind());
    } catch (const std::bad_alloc&) {
        session.console.end_progress();
        session.console.error("out of memory");
        return static_cast<int>(ErrorKind::runtime);
    } catch (const std::exception& defect) {
        session.console.end_progress();
        const auto* failure = dynamic_cast<const std::system_error*>(&defect);
        if (failure && std::ferror(stdout)) return output_lost(failure->code().value());
        session.console.error(std::string("a defect of patina, please report it: ") + defect.what());
        return static_cast<int>(ErrorKind::runtime);
    }
}

}  // namespace

int main(int argc, char** argv) {
    patina::keep_freed_memory();
    const int code = run(argc, argv);
    if (std::fflush(stdout) != 0 && code == 0) return output_lost(errno);
    return code;
}
