#include "patina/jobs/convert.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include <fmt/format.h>

#include "patina/brdf/half_angle_table.h"
#include "patina/brdf/merl_table.h"
#include "patina/brdf/tabulate.h"
#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/io/table_csv.h"
#include "patina/io/table_hdf5.h"
#include "patina/io/table_merl.h"
#include "patina/io/table_pbsdf.h"
#include "patina/spectral/colorimetry.h"
#include "patina/spectral/illuminants.h"

namespace patina::jobs {

namespace {

namespace fs = std::filesystem;
using brdf::MuellerTable;

constexpr double largest_zenith_deg = 80.0;  // nearer to grazing half-angle grids are mostly below the horizon

// Random directions, uniform in solid angle up to the largest zenith angle; the same ones in every run.
struct DirectionSample {
    brdf::DirectionPair pair;
    double mu_o, mu_i, phi;
};

std::vector<DirectionSample> random_directions(int count) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double lowest = std::cos(radians(largest_zenith_deg));
    std::vector<DirectionSample> samples;
    for (int k = 0; k < count; ++k) {
        const auto direction = [&](double mu, double azimuth) {
            const double s = std::sqrt(1 - mu * mu);
            return Eigen::Vector3d(s * std::cos(azimuth), s * std::sin(azimuth), mu);
        };
        const double mu_i = lowest + (1 - lowest) * uniform(random), mu_o = lowest + (1 - lowest) * uniform(random);
        brdf::DirectionPair pair =
            brdf::directions(brdf::half_angles(direction(mu_i, 0.0), direction(mu_o, 2 * pi * uniform(random))));
        samples.push_back({pair, mu_o, mu_i, brdf::relative_azimuth(pair)});
    }
    return samples;
}

// Largest and mean square difference of vectors of numbers, sample by sample.
class ErrorSum {
  public:
    template <class Values>
    void add(const Values& expected, const Values& found, double size) {
        const auto difference = (found - expected).eval();
        largest_ = std::max(largest_, difference.cwiseAbs().maxCoeff());
        squares_ += difference.squaredNorm();
        count_ += static_cast<int>(difference.size());
        scale_ = std::max(scale_, size);
    }
    ConversionError result(std::string of, int directions) const {
        return {std::move(of), directions, largest_, std::sqrt(squares_ / std::max(count_, 1)), scale_};
    }

  private:
    double largest_ = 0.0, squares_ = 0.0, scale_ = 0.0;
    int count_ = 0;
};

ConversionError mueller_error(const brdf::BodyFunction& expected, const brdf::BodyFunction& found,
                              const std::vector<double>& wavelengths_nm) {
    constexpr int count = 500;
    ErrorSum sum;
    for (const DirectionSample& s : random_directions(count))
        for (const double wavelength : wavelengths_nm) {
            const optics::Mueller reference = expected(wavelength, s.mu_o, s.mu_i, s.phi);
            sum.add(reference, found(wavelength, s.mu_o, s.mu_i, s.phi), reference(0, 0));
        }
    return sum.result("Mueller elements", count);
}

brdf::BodyFunction function_of(const MuellerTable& table) {
    return [&table](double wavelength, double mu_o, double mu_i, double phi) {
        return table.evaluate(wavelength, mu_o, mu_i, phi);
    };
}
brdf::BodyFunction function_of(const brdf::HalfAngleTable& table) {
    return [&table](double wavelength, double mu_o, double mu_i, double phi) {
        return table.evaluate_meridian(wavelength, mu_o, mu_i, phi);
    };
}

ConvertResult write_pbsdf(const MuellerTable& table, const ConvertRequest& request) {
    brdf::HalfAngleGrid grid;
    if (request.phi_d) grid.phi_d = request.phi_d;
    if (request.theta_d) grid.theta_d = request.theta_d;
    if (request.theta_h) grid.theta_h = request.theta_h;
    grid.wavelengths_nm = request.wavelengths_nm;
    ConvertResult result;
    if (!grid.wavelengths_nm.empty() && grid.wavelengths_nm.size() != 5)
        result.notes.push_back(
            fmt::format("Mitsuba 3 reads exactly five wavelengths; this file has {}", grid.wavelengths_nm.size()));
    io::write_table_pbsdf(brdf::to_half_angles(table, grid), request.output);
    const brdf::HalfAngleTable written = io::read_table_pbsdf(request.output);
    result.wavelengths_nm = written.wavelengths_nm;
    result.error = mueller_error(function_of(table), function_of(written), written.wavelengths_nm);
    return result;
}

// Linear sRGB under D65 of a reflectance given at the wavelengths: straight lines between them, constant beyond.
Eigen::Matrix3Xd rgb_weights(const std::vector<double>& wavelengths_nm) {
    Eigen::Matrix3Xd weights(3, std::ssize(wavelengths_nm));
    for (Eigen::Index w = 0; w < weights.cols(); ++w) {
        const auto hat = [&](double wavelength) {
            const double here = wavelengths_nm[w];
            if (wavelength <= here)
                return w == 0 ? 1.0 : std::max(0.0, 1 - (here - wavelength) / (here - wavelengths_nm[w - 1]));
            return w + 1 == weights.cols() ? 1.0
                                           : std::max(0.0, 1 - (wavelength - here) / (wavelengths_nm[w + 1] - here));
        };
        weights.col(w) = spectral::xyz_to_linear_srgb(spectral::xyz_of_reflectance(hat, spectral::illuminant_d65()));
    }
    return weights;
}

ConvertResult write_merl(const MuellerTable& table, const ConvertRequest& request) {
    const Eigen::Matrix3Xd weights = rgb_weights(table.wavelengths_nm);
    std::size_t clamped = 0;
    io::write_table_merl(brdf::to_merl(table, weights, &clamped), request.output);
    const brdf::MerlTable written = io::read_table_merl(request.output);
    ConvertResult result;
    result.wavelengths_nm = table.wavelengths_nm;
    result.notes.emplace_back("polarization is lost: the format holds linear sRGB under D65");
    if (table.wavelengths_nm.size() < 3) result.notes.emplace_back("fewer than three wavelengths make no colour");
    if (clamped > 0) result.notes.push_back(fmt::format("{} values outside sRGB were cut off at 0", clamped));

    // Each colour of the file is that of the middle of a cell.
    constexpr int count = 500;
    ErrorSum sum;
    for (const DirectionSample& s : random_directions(count)) {
        Eigen::Vector3d expected = Eigen::Vector3d::Zero();
        for (Eigen::Index w = 0; w < weights.cols(); ++w)
            expected += weights.col(w) * table.evaluate(table.wavelengths_nm[w], s.mu_o, s.mu_i, s.phi)(0, 0);
        expected = expected.cwiseMax(0.0);
        sum.add(expected, written.evaluate(brdf::half_angles(s.pair.i, s.pair.o)), expected.maxCoeff());
    }
    result.error = sum.result("linear sRGB", count);
    return result;
}

// The table at other wavelengths, for formats that take the table's own.
MuellerTable at_wavelengths(const MuellerTable& table, const std::vector<double>& wavelengths_nm) {
    if (wavelengths_nm.empty()) return table;
    brdf::TabulateOptions options{wavelengths_nm, static_cast<int>(table.mu.size()), 1};
    for (const brdf::BodyModes& body : table.body)
        options.orders = std::max(options.orders, static_cast<int>(body.modes.size()));
    for (const auto& layers : table.once_scattered)
        for (const brdf::OnceScattered& layer : layers)
            options.orders = std::max(options.orders, layer.scattering.order() + 1);
    return brdf::tabulate(function_of(table), options);
}

ConvertResult write_csv(const MuellerTable& table, const ConvertRequest& request) {
    io::CsvGrid grid;
    grid.wavelengths_nm = request.wavelengths_nm;
    io::write_table_csv(table, request.output, grid);
    ConvertResult result;
    result.wavelengths_nm = request.wavelengths_nm.empty() ? table.wavelengths_nm : request.wavelengths_nm;
    result.notes.emplace_back("values at listed directions, nine digits: nothing is interpolated");
    return result;
}

// A measured grid as Fourier modes on cosine nodes.
MuellerTable modes_of(const brdf::HalfAngleTable& grid, const std::vector<double>& wavelengths_nm) {
    brdf::TabulateOptions options{wavelengths_nm.empty() ? grid.wavelengths_nm : wavelengths_nm, 24, 32};
    MuellerTable table = brdf::tabulate(function_of(grid), options);
    table.provenance.solver = "none: tabulated from half angles";
    return table;
}

MuellerTable read_input(const ConvertRequest& request, std::optional<brdf::HalfAngleTable>& half_angles) {
    const std::string extension = request.input.extension().string();
    if (extension == ".h5") return io::read_table_hdf5(request.input);
    if (extension == ".pbsdf") {
        half_angles = io::read_table_pbsdf(request.input);
        return modes_of(*half_angles, request.wavelengths_nm);
    }
    if (extension == ".binary")
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: a MERL file has colours but no spectrum and no polarization to make another table from",
                        request.input.string()));
    throw Error(ErrorKind::usage, fmt::format("{}: unknown format \"{}\" (a BRDF table to read is .h5 or .pbsdf)",
                                              request.input.string(), extension));
}

void check_wavelengths(const std::vector<double>& wavelengths_nm, double lowest_nm, double highest_nm) {
    for (std::size_t k = 0; k < wavelengths_nm.size(); ++k) {
        if (k > 0 && wavelengths_nm[k] <= wavelengths_nm[k - 1])
            throw Error(ErrorKind::usage, "--wavelengths must ascend");
        if (wavelengths_nm[k] < lowest_nm || wavelengths_nm[k] > highest_nm)
            throw Error(ErrorKind::usage, fmt::format("{:g} nm lies outside the table ({:g} to {:g} nm)",
                                                      wavelengths_nm[k], lowest_nm, highest_nm));
    }
}

}  // namespace

ConvertResult convert(const ConvertRequest& request) {
    const std::string target = request.output.extension().string();
    const bool has_grid = request.phi_d || request.theta_d || request.theta_h;
    if (target != ".h5" && target != ".pbsdf" && target != ".binary" && target != ".csv")
        throw Error(ErrorKind::usage,
                    fmt::format("{}: unknown format \"{}\" (a BRDF table to write is .h5, .pbsdf, .binary or .csv)",
                                request.output.string(), target));
    if (has_grid && target != ".pbsdf")
        throw Error(ErrorKind::usage, "--grid sets the grid of a .pbsdf file; other formats have a fixed one");

    std::optional<brdf::HalfAngleTable> half_angles;
    const MuellerTable table = read_input(request, half_angles);
    if (!half_angles)
        check_wavelengths(request.wavelengths_nm, table.wavelengths_nm.front(), table.wavelengths_nm.back());

    ConvertResult result;
    if (target == ".pbsdf") result = write_pbsdf(table, request);
    if (target == ".binary") result = write_merl(at_wavelengths(table, request.wavelengths_nm), request);
    if (target == ".csv") result = write_csv(table, request);
    if (target == ".h5") {
        const MuellerTable output = half_angles ? table : at_wavelengths(table, request.wavelengths_nm);
        io::write_table_hdf5(output, request.output);
        result.wavelengths_nm = output.wavelengths_nm;
        result.error = half_angles
                           ? mueller_error(function_of(*half_angles), function_of(output), output.wavelengths_nm)
                           : mueller_error(function_of(table), function_of(output), output.wavelengths_nm);
    }
    if (half_angles)
        result.notes.emplace_back("the half-angle grid was brought to 24 cosine nodes and 32 Fourier orders");
    if (half_angles && target != ".h5") {
        const ConversionError through =
            mueller_error(function_of(*half_angles), function_of(table), table.wavelengths_nm);
        result.notes.push_back(fmt::format("that step errs by {:.1e} 1/sr at most, {:.1e} rms, at {} random directions",
                                           through.largest, through.rms, through.directions));
    }
    return result;
}

}  // namespace patina::jobs
