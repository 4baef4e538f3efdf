#pragma once
// What the command line says and where: results to stdout, everything else to stderr.

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "patina/core/progress.h"

namespace patina::cli {

enum class ProgressStyle { automatic, bar, plain, json, none };

class Console {
  public:
    bool json = false;
    bool quiet = false;
    int verbosity = 0;
    ProgressStyle progress_style = ProgressStyle::automatic;
    std::string color = "auto";  // auto | always | never; NO_COLOR is honoured by auto

    // A line of the result for people (silent with --json), and the one JSON document (silent without).
    void result(std::string_view line) const;
    void document(const nlohmann::json& document) const;

    // A remark for people on stderr; `hint` is the next useful command, printed after success. Silent when quiet.
    void note(std::string_view line) const;
    void hint(std::string_view command) const;
    void error(std::string_view message) const;

    bool colored_stderr() const;

    // A thread-safe receiver of progress reports in the chosen style, drawn on stderr at most ten times a second.
    ProgressCallback progress();
    // Ends the progress line, if one is open.
    void end_progress();

  private:
    void draw(const ProgressReport& report);

    std::mutex mutex_;
    std::chrono::steady_clock::time_point stage_start_, last_drawn_;
    std::string stage_;
    bool line_open_ = false;
};

}  // namespace patina::cli
