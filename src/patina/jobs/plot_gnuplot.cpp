#include "patina/jobs/plot_gnuplot.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "patina/core/error.h"
#include "patina/core/files.h"

namespace patina::jobs {

namespace fs = std::filesystem;

namespace {

// A folder of its own below the system's temporary one, removed with everything in it.
class ScratchFolder {
  public:
    ScratchFolder() {
        std::error_code ignored;
        std::string pattern = (fs::temp_directory_path(ignored) / "patina_plot_XXXXXX").string();
        if (::mkdtemp(pattern.data()) == nullptr)
            throw Error(ErrorKind::runtime, fmt::format("{}: cannot be made ({})", pattern, std::strerror(errno)));
        path_ = pattern;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

// The terminal, and `smoothing`, the finer steps a bitmap may give a coloured surface; in a vector figure every step is
// a polygon more to store.
std::string preamble(const std::string& extension, const FigureSize& size) {
    const bool vector = extension == ".svg";
    // Vector figures are read in browsers, which know generic families; bitmaps take the font that comes with
    // fontconfig.
    return fmt::format(
        "set encoding utf8\nset terminal {} noenhanced size {},{} font '{},{}' background 'white'\nsmoothing = {}\n",
        vector ? "svg" : "pngcairo", size.width_px, size.height_px,
        vector ? "DejaVu Sans,Verdana,sans-serif" : "DejaVu Sans", size.font_size_pt, vector ? 1 : 2);
}

// Runs gnuplot in the folder on its file figure.gp; what it says goes to messages.txt. Returns the exit status.
int run_gnuplot(const fs::path& folder) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "messages.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);

    // -d: no user's or system's init file, which could change the figure.
    std::string program = "gnuplot", plain = "-d", script = "figure.gp";
    char* arguments[] = {program.data(), plain.data(), script.data(), nullptr};
    pid_t child = 0;
    const int refused = ::posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (refused == ENOENT)
        throw Error(ErrorKind::not_built,
                    "figures need the program gnuplot, which was not found (Debian package gnuplot-nox)");
    if (refused != 0)
        throw Error(ErrorKind::runtime, fmt::format("gnuplot cannot be started ({})", std::strerror(refused)));

    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

}  // namespace

GnuplotScript& GnuplotScript::line(std::string_view commands) {
    text_.append(commands).push_back('\n');
    return *this;
}

GnuplotScript& GnuplotScript::begin_data(std::string_view name) {
    return line(fmt::format("${} << END_OF_DATA", name));
}

GnuplotScript& GnuplotScript::end_data() {
    return line("END_OF_DATA");
}

std::string gnuplot_quoted(std::string_view text) {
    std::string quoted = "'";
    for (char c : text) {
        if (c == '\'') quoted += '\'';
        quoted += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
    return quoted + "'";
}

void draw_with_gnuplot(const GnuplotScript& script, const FigureSize& size, const fs::path& path) {
    const std::string extension = path.extension().string();
    if (extension != ".png" && extension != ".svg")
        throw Error(ErrorKind::usage, fmt::format("{}: figures are written as .png or .svg", path.string()));

    // Gnuplot sees only names of our own; the figure is then moved to the user's.
    const ScratchFolder folder;
    const std::string figure = "figure" + extension;
    write_text_file(folder.path() / "figure.gp", fmt::format("{}set output '{}'\n{}unset output\n",
                                                             preamble(extension, size), figure, script.text()));
    const int status = run_gnuplot(folder.path());
    std::error_code ignored;
    if (status != 0 || !fs::exists(folder.path() / figure, ignored))
        throw Error(ErrorKind::runtime, fmt::format("{}: gnuplot failed: {}", path.string(),
                                                    read_text_file(folder.path() / "messages.txt").substr(0, 2000)));
    write_text_file(path, read_text_file(folder.path() / figure));
}

}  // namespace patina::jobs
