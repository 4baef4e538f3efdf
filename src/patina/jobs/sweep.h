#pragma once
// Paint metrics over a grid of recipe keys, point by point, so that an interrupted sweep goes on where it stopped.
//
// DIR/points/<key>.json holds one finished point, written whole; the key is a hash of the recipe with the point's
// values, of its optical constants and of the options, so that points of a changed recipe are never mistaken for this
// one's. When all points are there, DIR/sweep.h5 and DIR/sweep.csv gather them. Layout: docs/formats/sweep.md.

#include <filesystem>
#include <string>
#include <vector>

#include "patina/coating/paint_metrics.h"

namespace patina::jobs {

struct SweepAxis {
    std::string key;  // as in --set
    std::vector<double> values;
};

// "layers.0.thickness_um=1:200:24log": begin, end, count, both ends included, evenly spaced or in the logarithm.
// Throws Error(usage) for anything else.
SweepAxis parse_sweep_axis(const std::string& text);

struct SweepRequest {
    std::filesystem::path recipe;
    std::vector<std::string> settings;  // --set, made at every point before its own
    std::vector<SweepAxis> axes;        // at least one; the last varies fastest
    coating::PaintOptions options;      // wavelengths may be empty
    std::filesystem::path folder;
    std::string command;
};

struct SweepResult {
    std::size_t points = 0;
    std::size_t computed = 0, reused = 0;
    std::size_t foreign = 0;   // files of other recipes, grids or options in the folder, left alone
    bool interrupted = false;  // what is done is kept; the gathered files are not written
    bool converged = true;
    std::vector<std::string> columns;         // names of the quantities
    std::vector<std::vector<double>> values;  // [point][quantity], NaN where not defined
    std::vector<std::string> notes;
};

// Every point's recipe is checked before the first is computed. Throws Error(input) for a recipe that is wrong at a
// point, Error(usage) for a grid that makes no sense, Error(runtime) for a folder that cannot be written.
SweepResult sweep(const SweepRequest& request, const JobControl& control = {});

}  // namespace patina::jobs
