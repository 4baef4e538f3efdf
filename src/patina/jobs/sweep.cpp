#include "patina/jobs/sweep.h"

#include <charconv>
#include <cmath>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/io/grid_hdf5.h"
#include "patina/jobs/paint.h"
#include "patina/jobs/sweep_point.h"
#include "patina/version.h"

namespace patina::jobs {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_points = 1'000'000;

Error bad_axis(const std::string& text, const std::string& why) {
    return Error(ErrorKind::usage, fmt::format("--vary {}: {} (write KEY=begin:end:count or KEY=begin:end:countlog, as "
                                               "in layers.0.thickness_um=1:200:24log)",
                                               text, why));
}

template <class Number>
bool parse(std::string_view text, Number& value) {
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    return status == std::errc{} && end == text.data() + text.size();
}

// The value of twelve digits nearest to it: 0.14 rather than 0.13999999999999999.
double rounded(double value) {
    double result = value;
    parse(fmt::format("{:.12g}", value), result);
    return result;
}

std::vector<double> spaced(double begin, double end, int count, bool logarithmic) {
    std::vector<double> values{begin};
    for (int i = 1; i + 1 < count; ++i) {
        const double t = static_cast<double>(i) / (count - 1);
        values.push_back(rounded(logarithmic ? begin * std::pow(end / begin, t) : begin + (end - begin) * t));
    }
    if (count > 1) values.push_back(end);
    return values;
}

// The grid, its points numbered in C order.
class Grid {
  public:
    explicit Grid(const std::vector<SweepAxis>& axes) : axes_(axes) {
        if (axes.empty()) throw Error(ErrorKind::usage, "a sweep needs at least one --vary KEY=begin:end:count");
        std::set<std::string> keys;
        for (const SweepAxis& axis : axes) {
            if (!keys.insert(axis.key).second)
                throw Error(ErrorKind::usage, fmt::format("--vary {} is given twice", axis.key));
            if (axis.values.size() > most_points / size_)
                throw Error(ErrorKind::usage, fmt::format("a sweep of more than {} points", most_points));
            size_ *= axis.values.size();
        }
    }

    std::size_t size() const { return size_; }

    std::vector<double> values(std::size_t point) const {
        std::vector<double> result(axes_.size());
        for (std::size_t a = axes_.size(); a-- > 0; point /= axes_[a].values.size())
            result[a] = axes_[a].values[point % axes_[a].values.size()];
        return result;
    }

    std::vector<std::string> settings(std::size_t point) const {
        const std::vector<double> at = values(point);
        std::vector<std::string> result;
        for (std::size_t a = 0; a < axes_.size(); ++a) result.push_back(fmt::format("{}={}", axes_[a].key, at[a]));
        return result;
    }

  private:
    const std::vector<SweepAxis>& axes_;
    std::size_t size_ = 1;
};

class Sweep {
  public:
    Sweep(const SweepRequest& request, const JobControl& control)
        : request_(request), control_(control), grid_(request.axes) {}

    SweepResult run() {
        prepare();
        points_.resize(grid_.size());
        std::size_t done = 0;
        for (std::size_t p = 0; p < grid_.size(); ++p)
            if ((points_[p] = read_sweep_point(file_of(p), keys_[p], quantities_))) ++done;
        result_.reused = done;

        for (std::size_t p = 0; p < grid_.size() && !result_.interrupted; ++p) {
            if (points_[p]) continue;
            compute(p);
            if (!result_.interrupted)
                control_.report({"sweep", static_cast<std::int64_t>(++done), std::ssize(points_),
                                 fmt::format("{}", fmt::join(grid_.settings(p), ", "))});
        }
        result_.computed = done - result_.reused;
        if (!result_.interrupted) gather();
        return std::move(result_);
    }

  private:
    // Checks every point's recipe, names its file, and makes the folder.
    void prepare() {
        bool optical = false;
        for (std::size_t p = 0; p < grid_.size(); ++p) {
            const coating::Recipe recipe = recipe_of(p);
            keys_.push_back(sweep_point_key(recipe, options_for(recipe)));
            optical = coating::variable_layer(recipe).is_optical;
        }
        quantities_ = sweep_quantities(optical);
        for (const SweepQuantity& quantity : quantities_) result_.columns.push_back(quantity.name);
        result_.points = grid_.size();

        std::error_code error;
        fs::create_directories(request_.folder / "points", error);
        if (error)
            throw Error(ErrorKind::runtime,
                        fmt::format("{}: {}", (request_.folder / "points").string(), error.message()));
        expect_writable(request_.folder / "sweep.h5");
        const std::set<std::string> own(keys_.begin(), keys_.end());
        for (const fs::directory_entry& entry : fs::directory_iterator(request_.folder / "points"))
            if (entry.path().extension() == ".json" && !own.contains(entry.path().stem().string())) ++result_.foreign;
    }

    coating::Recipe recipe_of(std::size_t point) const {
        std::vector<std::string> settings = request_.settings;
        for (const std::string& setting : grid_.settings(point)) settings.push_back(setting);
        return coating::read_recipe(request_.recipe, settings);
    }

    // The recipe's text at a point, whatever the thickness of the variable layer is there.
    std::string composition(std::size_t point) const {
        std::vector<std::string> settings = request_.settings;
        for (const std::string& setting : grid_.settings(point)) settings.push_back(setting);
        const int layer = coating::variable_layer(coating::read_recipe(request_.recipe, settings)).index;
        for (const char* name : {"thickness_um", "optical_thickness"}) {
            const std::string key = fmt::format("layers.{}.{}", layer, name);
            for (const SweepAxis& axis : request_.axes)
                if (axis.key == key) settings.push_back(key + "=1");
        }
        return coating::read_recipe(request_.recipe, settings).text;
    }

    coating::PaintOptions options_for(const coating::Recipe& recipe) const {
        coating::PaintOptions options = request_.options;
        options.stack.wavelengths_nm = paint_wavelengths(recipe, options.stack.wavelengths_nm);
        return options;
    }

    fs::path file_of(std::size_t point) const { return request_.folder / "points" / (keys_[point] + ".json"); }

    // The wavelengths of a point run in parallel; points follow each other, so that a stop loses one at most.
    void compute(std::size_t point) {
        PaintRequest paint_request;
        paint_request.options = request_.options;
        paint_request.angular = false;
        paint_request.options.stack.memory = memory_;
        paint_request.options.stack.composition = composition(point);
        try {
            const PaintReport report = paint(recipe_of(point), paint_request, {{}, control_.cancel});
            points_[point] = sweep_point(report.metrics);
            notes_.insert(report.metrics.notes.begin(), report.metrics.notes.end());
            write_sweep_point(file_of(point), keys_[point], quantities_, grid_.settings(point), *points_[point]);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::interrupted) {
                result_.interrupted = true;
                return;
            }
            throw Error(error.kind(), fmt::format("at {}: {}", fmt::join(grid_.settings(point), ", "), error.what()));
        }
    }

    // Every point into one file of each kind.
    void gather() {
        for (const auto& point : points_) {
            result_.values.push_back(point->quantities);
            result_.converged = result_.converged && point->converged;
        }
        result_.notes.assign(notes_.begin(), notes_.end());
        write_csv();
        write_hdf5();
    }

    void write_csv() const {
        std::string text;
        for (const SweepAxis& axis : request_.axes) text += axis.key + ",";
        text += fmt::format("{}\n", fmt::join(result_.columns, ","));
        for (std::size_t p = 0; p < grid_.size(); ++p) {
            text += fmt::format("{}", fmt::join(grid_.values(p), ","));
            for (const double value : result_.values[p]) text += std::isfinite(value) ? fmt::format(",{}", value) : ",";
            text += '\n';
        }
        write_text_file(request_.folder / "sweep.csv", text);
    }

    void write_hdf5() const {
        std::vector<io::GridAxis> axes;
        std::vector<int> grid_axes;
        for (const SweepAxis& axis : request_.axes) {
            grid_axes.push_back(static_cast<int>(axes.size()));
            axes.push_back({axis.key, units_of(axis.key), axis.values});
        }
        std::vector<io::GridVariable> variables;
        for (std::size_t q = 0; q < quantities_.size(); ++q) {
            variables.push_back({quantities_[q].name, quantities_[q].units, quantities_[q].long_name, grid_axes, {}});
            for (const std::vector<double>& point : result_.values) variables.back().values.push_back(point[q]);
        }
        std::vector<int> with_wavelength = grid_axes;
        with_wavelength.push_back(static_cast<int>(axes.size()));
        axes.push_back({"wavelength_nm", "nm", points_.front()->wavelengths_nm});
        variables.push_back(
            {"reflectance_45_0", "1", "reflectance factor over the own base, 45:0", with_wavelength, {}});
        for (const auto& point : points_)
            variables.back().values.insert(variables.back().values.end(), point->reflectance_45_0.begin(),
                                           point->reflectance_45_0.end());
        io::write_grid_hdf5(request_.folder / "sweep.h5", axes, variables,
                            {{"format", "patina-sweep"},
                             {"format_version", "1"},
                             {"command", request_.command},
                             {"recipe", coating::read_recipe(request_.recipe, request_.settings).text},
                             {"recipe_path", request_.recipe.string()},
                             {"software", std::string("patina ") + PATINA_VERSION}});
    }

    // The unit a key carries in its name.
    static std::string units_of(const std::string& key) {
        if (key.ends_with("_um")) return "um";
        if (key.ends_with("_nm")) return "nm";
        if (key.ends_with("_per_um3")) return "1/um3";
        if (key.ends_with("_um2")) return "um2";
        if (key.ends_with("_um3")) return "um3";
        if (key.ends_with("_g_cm3")) return "g/cm3";
        if (key.ends_with("_percent")) return "%";
        return "1";
    }

    const SweepRequest& request_;
    const JobControl& control_;
    Grid grid_;
    std::vector<SweepQuantity> quantities_;
    std::vector<std::string> keys_;
    std::vector<std::optional<SweepPoint>> points_;
    std::set<std::string> notes_;
    std::shared_ptr<coating::StackMemory> memory_ = std::make_shared<coating::StackMemory>();
    SweepResult result_;
};

}  // namespace

SweepAxis parse_sweep_axis(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) throw bad_axis(text, "no key");
    std::string_view range = std::string_view(text).substr(equals + 1);
    const std::size_t first = range.find(':'), second = range.find(':', first + 1);
    if (first == std::string_view::npos || second == std::string_view::npos) throw bad_axis(text, "no begin:end:count");
    std::string_view count_text = range.substr(second + 1);
    const bool logarithmic = count_text.ends_with("log");
    if (logarithmic) count_text.remove_suffix(3);

    double begin = 0.0, end = 0.0;
    int count = 0;
    if (!parse(range.substr(0, first), begin) || !std::isfinite(begin)) throw bad_axis(text, "begin is not a number");
    if (!parse(range.substr(first + 1, second - first - 1), end) || !std::isfinite(end))
        throw bad_axis(text, "end is not a number");
    if (!parse(count_text, count)) throw bad_axis(text, "count is not a whole number");
    if (count < 1 || count > static_cast<int>(most_points))
        throw bad_axis(text, fmt::format("a count of {}, at least 1 and at most {}", count, most_points));
    if (count == 1 && begin != end) throw bad_axis(text, "one value cannot be both begin and end");
    if (count > 1 && begin == end) throw bad_axis(text, "begin and end are the same");
    if (logarithmic && !(begin > 0.0 && end > 0.0)) throw bad_axis(text, "a logarithmic range must be above 0");
    return {text.substr(0, equals), spaced(begin, end, count, logarithmic)};
}

SweepResult sweep(const SweepRequest& request, const JobControl& control) {
    return Sweep(request, control).run();
}

}  // namespace patina::jobs
