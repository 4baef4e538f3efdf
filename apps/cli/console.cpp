#include "console.h"

#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>
#include <unistd.h>

namespace patina::cli {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point begin, Clock::time_point end) {
    return std::chrono::duration<double>(end - begin).count();
}

std::string duration_text(double seconds) {
    if (seconds < 60) return fmt::format("{:.0f} s", seconds);
    if (seconds < 3600) return fmt::format("{:.0f} min {:02.0f} s", std::floor(seconds / 60), std::fmod(seconds, 60));
    return fmt::format("{:.0f} h {:02.0f} min", std::floor(seconds / 3600), std::floor(std::fmod(seconds, 3600) / 60));
}

bool stderr_is_terminal() {
    return ::isatty(STDERR_FILENO) == 1;
}

}  // namespace

void Console::result(std::string_view line) const {
    if (!json) fmt::print("{}\n", line);
}

void Console::document(const nlohmann::json& document) const {
    if (json) fmt::print("{}\n", document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void Console::note(std::string_view line) const {
    if (!quiet) fmt::print(stderr, "{}\n", line);
}

void Console::hint(std::string_view command) const {
    if (quiet || json) return;
    fmt::print(stderr, fmt::runtime(colored_stderr() ? "\033[2mnext: {}\033[0m\n" : "next: {}\n"), command);
}

void Console::error(std::string_view message) const {
    fmt::print(stderr, fmt::runtime(colored_stderr() ? "\033[1;31merror:\033[0m {}\n" : "error: {}\n"), message);
}

bool Console::colored_stderr() const {
    if (color == "always") return true;
    if (color == "never" || std::getenv("NO_COLOR")) return false;
    return stderr_is_terminal();
}

ProgressCallback Console::progress() {
    if (progress_style == ProgressStyle::none) return {};
    if (progress_style == ProgressStyle::automatic && (quiet || !stderr_is_terminal())) return {};
    return [this](const ProgressReport& report) { draw(report); };
}

void Console::draw(const ProgressReport& report) {
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    const bool new_stage = report.stage != stage_;
    const bool finished = report.total > 0 && report.done >= report.total;
    if (new_stage) {
        if (line_open_) fmt::print(stderr, "\n");
        line_open_ = false;
        stage_ = report.stage;
        stage_start_ = now;
    } else if (!finished && seconds_between(last_drawn_, now) < 0.1) {
        return;
    }
    last_drawn_ = now;

    const double fraction =
        report.total > 0 ? (static_cast<double>(report.done) + report.part) / static_cast<double>(report.total) : 0.0;
    const double elapsed = seconds_between(stage_start_, now);
    const double left = fraction > 0 ? elapsed * (1 - fraction) / fraction : 0.0;

    if (progress_style == ProgressStyle::json) {
        const nlohmann::json line = {{"stage", report.stage}, {"done", report.done},     {"total", report.total},
                                     {"part", report.part},   {"detail", report.detail}, {"elapsed_s", elapsed},
                                     {"left_s", left}};
        fmt::print(stderr, "{}\n", line.dump());
    } else if (progress_style == ProgressStyle::plain) {
        // The time left is known once there is progress; some stages know no end.
        const std::string share = report.total > 0 ? fmt::format("/{}", report.total) : "",
                          left_text = fraction > 0
                                          ? fmt::format(" ({:.0f} %, {} left)", 100 * fraction, duration_text(left))
                                          : "";
        fmt::print(stderr, "{} {}{} {}{}\n", report.stage, report.done, share, report.detail, left_text);
    } else {
        constexpr int width = 30;
        const int filled = static_cast<int>(fraction * width);
        const std::string remaining = finished       ? "in " + duration_text(elapsed)
                                      : fraction > 0 ? duration_text(left) + " left"
                                                     : "";
        fmt::print(stderr, "\r\033[K{:<10} [{:=<{}}{:<{}}] {:3.0f} %  {}  {}", report.stage, "", filled, "",
                   width - filled, 100 * fraction, remaining, report.detail);
        std::fflush(stderr);
        line_open_ = true;
        if (finished) {
            fmt::print(stderr, "\n");
            line_open_ = false;
        }
    }
}

void Console::end_progress() {
    const std::lock_guard lock(mutex_);
    if (line_open_) fmt::print(stderr, "\n");
    line_open_ = false;
    stage_.clear();
}

}  // namespace patina::cli
