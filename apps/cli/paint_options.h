#pragma once
// The options that `paint` and `sweep` share.

#include <string>
#include <vector>

#include "command.h"

#include "patina/coating/paint_metrics.h"

namespace patina::cli {

struct PaintCommandOptions {
    std::string recipe, wavelengths;
    std::vector<std::string> settings;
    double tolerance = 1e-3;
    int streams = 0;
    std::string solver = "doubling";
    double white = 0.80, contrast = 0.98;
};

// `options` must outlive the parsing.
void add_paint_options(CLI::App& command, PaintCommandOptions& options);
coating::PaintOptions to_paint_options(const PaintCommandOptions& options);

}  // namespace patina::cli
