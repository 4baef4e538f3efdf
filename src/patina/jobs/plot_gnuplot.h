#pragma once
// Running gnuplot on a script, safely: no shell, no user's text as a command, no init files.

#include <filesystem>
#include <string>
#include <string_view>

namespace patina::jobs {

// The script's text in the making.
class GnuplotScript {
  public:
    // Appends a line of commands.
    GnuplotScript& line(std::string_view commands);
    // Begins the named block "$name" of inline data; rows follow by line().
    GnuplotScript& begin_data(std::string_view name);
    GnuplotScript& end_data();
    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

// A text as gnuplot's single-quoted string, in which nothing is substituted or executed. Control characters become
// spaces.
std::string gnuplot_quoted(std::string_view text);

struct FigureSize {
    int width_px = 1000, height_px = 700;
    double font_size_pt = 16;
};

// Runs the script with its terminal set for the extension of `path` (.png or .svg) and writes the figure whole or not
// at all. Throws Error(usage) for another extension, Error(not_built) without gnuplot, Error(runtime) when it fails.
void draw_with_gnuplot(const GnuplotScript& script, const FigureSize& size, const std::filesystem::path& path);

}  // namespace patina::jobs
