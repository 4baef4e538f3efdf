#include "patina/io/table_hdf5.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "patina/core/files.h"
#include "patina/io/table_hdf5_file.h"

namespace patina::io {

using brdf::MuellerTable;
using hdf5::Shape;
using optics::Mueller;

namespace {

using RowMajorMode = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using RowMajorMueller = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

constexpr const char* format_name = "patina-mueller-table";

struct Convention {
    const char *name, *text;
};

// Root attributes: whoever opens the file without the manual must be able to use it. docs/formats says the same at
// length.
constexpr Convention conventions[] = {
    {"convention_brdf",
     "S_out = integral of f S_in cos(theta_in) d omega_in; f in 1/sr, without cosine and without the specular part"},
    {"convention_stokes",
     "(I, Q, U, V); p in the meridian plane of the ray, s parallel to the surface, s x p = propagation; I = |Ep|^2 + "
     "|Es|^2, "
     "Q = |Ep|^2 - |Es|^2, U = 2 Re(Ep Es*), V = -2 Im(Ep Es*), fields ~ exp(-i w t)"},
    {"convention_azimuth",
     "phi = azimuth of the outgoing minus that of the incident PROPAGATION direction, right-handed about the outward "
     "normal; "
     "phi = 0 is the side of the mirror reflection"},
    {"convention_fourier",
     "f(phi) = sum over m of (2 - delta_m0) t_m(phi) body[m]; t = cos(m phi) for {I,Q}<-{I,Q} and {U,V}<-{U,V}, -sin(m "
     "phi) "
     "for {I,Q}<-{U,V}, +sin(m phi) for {U,V}<-{I,Q}"},
    {"convention_interpolation",
     "Lagrange polynomials on mu for body[m], after division of odd m by sqrt((1 - mu_out^2)(1 - mu_in^2)); linear in "
     "wavelength, clamped at the ends"},
    {"convention_once_scattered",
     "where there is a group once_scattered, the body BRDF is that of the modes plus its closed form "
     "(docs/formats/mueller_table_hdf5.md)"},
    {"convention_specular",
     "radiance out along the mirror direction = specular radiance in, same Stokes frames; total = specular_surface + "
     "specular_coherent"},
};

// Flattens nested 4x4 matrices [W][A] to (W, A, 4, 4).
std::vector<double> flatten(const std::vector<std::vector<Mueller>>& specular) {
    std::vector<double> values;
    for (const auto& angles : specular)
        for (const Mueller& mueller : angles) {
            const RowMajorMueller row_major = mueller;
            values.insert(values.end(), row_major.data(), row_major.data() + 16);
        }
    return values;
}

// Modes as (W, M, N, 4, N, 4); wavelengths with fewer modes are filled with zeros.
std::vector<double> flatten(const std::vector<brdf::BodyModes>& body, std::size_t orders, std::size_t mode_size) {
    std::vector<double> values(body.size() * orders * mode_size * mode_size, 0.0);
    const auto size = static_cast<Eigen::Index>(mode_size);
    for (std::size_t w = 0; w < body.size(); ++w)
        for (std::size_t m = 0; m < body[w].modes.size(); ++m)
            RowMajorMode::Map(values.data() + (w * orders + m) * mode_size * mode_size, size, size) = body[w].modes[m];
    return values;
}

void write_axis(hdf5::Writer& file, const std::string& name, const std::vector<double>& values, const char* units,
                const char* long_name) {
    file.dataset(name, {values.size()}, values);
    file.make_scale(name);
    file.attribute(name, "units", units);
    file.attribute(name, "long_name", long_name);
}

void write_axes(hdf5::Writer& file, const MuellerTable& table, std::size_t orders) {
    std::vector<double> fourier_order(orders);
    for (std::size_t m = 0; m < orders; ++m) fourier_order[m] = static_cast<double>(m);
    write_axis(file, "wavelength_nm", table.wavelengths_nm, "nm", "vacuum wavelength");
    write_axis(file, "fourier_order", fourier_order, "1", "order m of the Fourier series in azimuth");
    write_axis(file, "mu", table.mu, "1", "cosine of the angle from the outward normal, in air: outgoing light");
    write_axis(file, "mu_in", table.mu, "1",
               "cosine of the angle from the outward normal, in air: incident light; = mu");
    write_axis(file, "specular_theta_deg", table.specular_theta_deg, "degree", "angle of incidence from the normal");
    const std::string names[] = {"I", "Q", "U", "V"};
    for (const char* axis : {"stokes", "stokes_in"}) {
        file.dataset(axis, names);
        file.make_scale(axis);
        file.attribute(axis, "long_name", "Stokes component");
    }
}

void write_values(hdf5::Writer& file, const MuellerTable& table, std::size_t orders, const TableWriteOptions& options) {
    const hsize_t w = table.wavelengths_nm.size(), m = orders, n = table.mu.size(), a = table.specular_theta_deg.size();
    file.dataset("mu_weight", {n}, table.mu_weights);
    file.attach_scales("mu_weight", {"mu"}, {"mu"});
    file.attribute("mu_weight", "units", "1");
    file.attribute("mu_weight", "long_name", "quadrature weight of d mu on (0, 1)");

    // One chunk a wavelength: what is read together lies together.
    hdf5::DatasetOptions storage{
        options.single_precision, {1, m, n, 4, n, 4}, static_cast<unsigned>(options.compression_level)};
    file.dataset("body", {w, m, n, 4, n, 4}, flatten(table.body, orders, 4 * n), storage);
    file.attach_scales("body", {"wavelength_nm", "fourier_order", "mu", "stokes", "mu_in", "stokes_in"},
                       {"wavelength_nm", "fourier_order", "mu_out", "stokes_out", "mu_in", "stokes_in"});
    file.attribute("body", "units", "1/sr");
    file.attribute("body", "long_name", "Fourier modes of the Mueller BRDF of the body (subsurface) reflection");

    storage = {false, {w, a, 4, 4}, static_cast<unsigned>(options.compression_level)};
    const std::pair<const char*, const char*> parts[] = {
        {"specular_surface", "Mueller matrix of the reflection at the top interface"},
        {"specular_coherent", "Mueller matrix of the unscattered beam returned by a mirror-like base"}};
    for (const auto& [name, meaning] : parts) {
        const bool surface = std::string_view(name) == "specular_surface";
        file.dataset(name, {w, a, 4, 4}, flatten(surface ? table.specular_surface : table.specular_coherent), storage);
        file.attach_scales(name, {"wavelength_nm", "specular_theta_deg", "stokes", "stokes_in"},
                           {"wavelength_nm", "specular_theta_deg", "stokes_out", "stokes_in"});
        file.attribute(name, "units", "1");
        file.attribute(name, "long_name", meaning);
    }
    if (table.error_estimate.empty()) return;
    file.dataset("error_estimate", {w}, table.error_estimate);
    file.attach_scales("error_estimate", {"wavelength_nm"}, {"wavelength_nm"});
    file.attribute("error_estimate", "units", "1/sr");
    file.attribute("error_estimate", "long_name", "estimated largest absolute error of the body BRDF");
}

constexpr std::vector<double> optics::ExpansionCoefficients::*coefficient_lists[] = {
    &optics::ExpansionCoefficients::alpha1, &optics::ExpansionCoefficients::alpha2,
    &optics::ExpansionCoefficients::alpha3, &optics::ExpansionCoefficients::alpha4,
    &optics::ExpansionCoefficients::beta1,  &optics::ExpansionCoefficients::beta2};

// Once scattered light, in arrays as large as the wavelength of most layers and orders needs; layers that only fill up
// have no scattering coefficients but zeros.
void write_once_scattered(hdf5::Writer& file, const MuellerTable& table) {
    std::size_t layers = 0, orders = 3;
    for (const auto& at_w : table.once_scattered) {
        layers = std::max(layers, at_w.size());
        for (const brdf::OnceScattered& layer : at_w) orders = std::max(orders, layer.scattering.alpha1.size());
    }
    if (layers == 0) return;
    const std::size_t w_count = table.wavelengths_nm.size(), angles = table.specular_theta_deg.size();
    std::vector<double> index(w_count * layers, 1.0), thickness(w_count * layers, 0.0),
        scattering(w_count * layers * 6 * orders, 0.0), down(w_count * layers * angles * 16, 0.0), up = down;
    for (std::size_t w = 0; w < w_count; ++w)
        for (std::size_t k = 0; k < table.once_scattered[w].size(); ++k) {
            const brdf::OnceScattered& layer = table.once_scattered[w][k];
            const std::size_t at = w * layers + k;
            index[at] = layer.index_ratio;
            thickness[at] = layer.optical_thickness;
            for (std::size_t list = 0; list < 6; ++list)
                std::ranges::copy(layer.scattering.*coefficient_lists[list],
                                  scattering.begin() + static_cast<std::ptrdiff_t>((at * 6 + list) * orders));
            for (std::size_t a = 0; a < angles; ++a) {
                RowMajorMueller::Map(down.data() + 16 * (at * angles + a)) = layer.down[a];
                RowMajorMueller::Map(up.data() + 16 * (at * angles + a)) = layer.up[a];
            }
        }
    file.group("/once_scattered");
    file.dataset("/once_scattered/index_ratio", {w_count, layers}, index);
    file.dataset("/once_scattered/optical_thickness", {w_count, layers}, thickness);
    file.dataset("/once_scattered/scattering", {w_count, layers, 6, orders}, scattering);
    const hdf5::DatasetOptions storage{false, {1, layers, angles, 4, 4}, 1};
    file.dataset("/once_scattered/down", {w_count, layers, angles, 4, 4}, down, storage);
    file.dataset("/once_scattered/up", {w_count, layers, angles, 4, 4}, up, storage);
}

void write_provenance(hdf5::Writer& file, const brdf::Provenance& provenance) {
    const std::string group = "/provenance";
    file.group(group);
    file.attribute(group, "command", provenance.command);
    file.attribute(group, "recipe", provenance.recipe);
    file.attribute(group, "recipe_path", provenance.recipe_path);
    file.attribute(group, "software", provenance.software);
    file.attribute(group, "solver", provenance.solver);
    // Text that is not UTF-8 is mended rather than refused: a note must not cost the user the table.
    file.attribute(group, "notes_json",
                   nlohmann::json(provenance.notes).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

// The values of a one-dimensional dataset.
std::vector<double> read_axis(const hdf5::Reader& file, const std::string& name) {
    return file.numbers(name, 1).values;
}

hdf5::Reader::Numbers read_shaped(const hdf5::Reader& file, const std::string& name, const Shape& expected) {
    hdf5::Reader::Numbers numbers = file.numbers(name, expected.size());
    for (std::size_t axis = 0; axis < expected.size(); ++axis)
        if (expected[axis] != 0 && numbers.shape[axis] != expected[axis])
            file.fail("dataset " + name, fmt::format("has the shape ({})", fmt::join(numbers.shape, ", ")),
                      fmt::format("dimension {} should have {} entries, as its axis has", axis, expected[axis]));
    return numbers;
}

std::vector<std::vector<Mueller>> read_specular(const hdf5::Reader& file, const std::string& name, hsize_t wavelengths,
                                                hsize_t angles) {
    const auto numbers = read_shaped(file, name, {wavelengths, angles, 4, 4});
    std::vector<std::vector<Mueller>> result(wavelengths, std::vector<Mueller>(angles));
    for (hsize_t w = 0; w < wavelengths; ++w)
        for (hsize_t a = 0; a < angles; ++a)
            result[w][a] = RowMajorMueller::Map(numbers.values.data() + 16 * (w * angles + a));
    return result;
}

std::vector<brdf::BodyModes> read_body(const hdf5::Reader& file, hsize_t wavelengths, hsize_t nodes) {
    const auto numbers = read_shaped(file, "body", {wavelengths, 0, nodes, 4, nodes, 4});
    const hsize_t orders = numbers.shape[1], size = 4 * nodes;
    std::vector<brdf::BodyModes> body(wavelengths);
    for (hsize_t w = 0; w < wavelengths; ++w) {
        for (hsize_t m = 0; m < orders; ++m)
            body[w].modes.emplace_back(RowMajorMode::Map(numbers.values.data() + (w * orders + m) * size * size,
                                                         static_cast<Eigen::Index>(size),
                                                         static_cast<Eigen::Index>(size)));
        // Modes that only fill up the array are none.
        while (body[w].modes.size() > 1 && body[w].modes.back().isZero(0.0)) body[w].modes.pop_back();
    }
    return body;
}

std::vector<std::vector<brdf::OnceScattered>> read_once_scattered(const hdf5::Reader& file, hsize_t wavelengths,
                                                                  hsize_t angles) {
    if (!file.has("/once_scattered")) return {};
    const auto index = read_shaped(file, "/once_scattered/index_ratio", {wavelengths, 0});
    const hsize_t layers = index.shape[1];
    const auto thickness = read_shaped(file, "/once_scattered/optical_thickness", {wavelengths, layers});
    const auto scattering = read_shaped(file, "/once_scattered/scattering", {wavelengths, layers, 6, 0});
    const auto down = read_shaped(file, "/once_scattered/down", {wavelengths, layers, angles, 4, 4}),
               up = read_shaped(file, "/once_scattered/up", {wavelengths, layers, angles, 4, 4});
    const hsize_t orders = scattering.shape[3];
    std::vector<std::vector<brdf::OnceScattered>> result(wavelengths);
    for (hsize_t at = 0; at < wavelengths * layers; ++at) {
        brdf::OnceScattered layer{index.values[at], thickness.values[at], {}, {}, {}};
        for (hsize_t list = 0; list < 6; ++list) {
            const auto first = scattering.values.begin() + static_cast<std::ptrdiff_t>((at * 6 + list) * orders);
            (layer.scattering.*coefficient_lists[list]).assign(first, first + static_cast<std::ptrdiff_t>(orders));
        }
        // A layer that only fills up the array is none.
        if (std::ranges::all_of(layer.scattering.alpha1, [](double x) { return x == 0.0; })) continue;
        for (hsize_t a = 0; a < angles; ++a) {
            layer.down.emplace_back(RowMajorMueller::Map(down.values.data() + 16 * (at * angles + a)));
            layer.up.emplace_back(RowMajorMueller::Map(up.values.data() + 16 * (at * angles + a)));
        }
        result[at / layers].push_back(std::move(layer));
    }
    return result;
}

brdf::Provenance read_provenance(const hdf5::Reader& file) {
    brdf::Provenance provenance;
    const std::string group = "/provenance";
    if (!file.has(group)) return provenance;
    const auto text = [&](const char* name) {
        return file.has_attribute(group, name) ? file.text_attribute(group, name) : std::string();
    };
    provenance.command = text("command");
    provenance.recipe = text("recipe");
    provenance.recipe_path = text("recipe_path");
    provenance.software = text("software");
    provenance.solver = text("solver");
    const nlohmann::json notes = nlohmann::json::parse(text("notes_json"), nullptr, false);
    if (notes.is_object())
        for (const auto& [key, value] : notes.items())
            provenance.notes[key] = value.is_string() ? value.get<std::string>() : value.dump();
    return provenance;
}

void require_format(const hdf5::Reader& file) {
    if (!file.has_attribute("/", "format"))
        file.fail("the file", "is not a Mueller BRDF table", "the root has no attribute \"format\"");
    const std::string format = file.text_attribute("/", "format");
    if (format != format_name) file.fail("the file", fmt::format("is not a Mueller BRDF table but \"{}\"", format));
    const int version = file.int_attribute("/", "format_version");
    if (version < 1 || version > mueller_table_format_version)
        file.fail("the file", fmt::format("has format version {}", version),
                  fmt::format("this program reads 1 .. {}", mueller_table_format_version));
}

}  // namespace

void write_table_hdf5(const MuellerTable& table, const std::filesystem::path& path, const TableWriteOptions& options) {
    table.validate({path.string()});
    std::size_t orders = 1;
    for (const brdf::BodyModes& modes : table.body) orders = std::max(orders, modes.modes.size());

    std::string image;
    {
        hdf5::Writer file;
        file.attribute("/", "format", format_name);
        const bool closed_forms = std::ranges::any_of(table.once_scattered, [](const auto& x) { return !x.empty(); });
        file.attribute("/", "format_version", closed_forms ? mueller_table_format_version : 1);
        file.attribute("/", "title", "Mueller BRDF of a coating");
        for (const Convention& convention : conventions) file.attribute("/", convention.name, convention.text);
        write_axes(file, table, orders);
        write_values(file, table, orders, options);
        write_once_scattered(file, table);
        write_provenance(file, table.provenance);
        image = file.image();
    }
    write_text_file(path, image);
}

MuellerTable read_table_hdf5(const std::filesystem::path& path) {
    const hdf5::Reader file(path);
    require_format(file);
    MuellerTable table;
    table.wavelengths_nm = read_axis(file, "wavelength_nm");
    table.mu = read_axis(file, "mu");
    table.mu_weights = read_axis(file, "mu_weight");
    table.specular_theta_deg = read_axis(file, "specular_theta_deg");
    const hsize_t wavelengths = table.wavelengths_nm.size(), angles = table.specular_theta_deg.size();
    table.body = read_body(file, wavelengths, table.mu.size());
    table.specular_surface = read_specular(file, "specular_surface", wavelengths, angles);
    table.specular_coherent = read_specular(file, "specular_coherent", wavelengths, angles);
    table.once_scattered = read_once_scattered(file, wavelengths, angles);
    if (file.has("error_estimate")) table.error_estimate = read_axis(file, "error_estimate");
    table.provenance = read_provenance(file);
    table.validate({path.string()});
    return table;
}

}  // namespace patina::io
