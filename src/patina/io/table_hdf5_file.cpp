#include "patina/io/table_hdf5_file.h"

#include <fstream>
#include <utility>

#include <fmt/format.h>
#include <hdf5_hl.h>

#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/core/fingerprint.h"

namespace patina::io::hdf5 {

namespace {

// More values than any table holds: a damaged header must not ask for all memory.
constexpr hsize_t largest_value_count = hsize_t{1} << 31;
constexpr std::size_t longest_text = std::size_t{1} << 28;
// What deflate can make of a byte at most (RFC 1951: 258 from 2 bits).
constexpr hsize_t largest_expansion = 1032;

std::mutex& library_mutex() {
    static std::mutex mutex;
    return mutex;
}

// The library refuses a write in memory only when memory is short or this program asks for nonsense.
void require(bool accepted, const std::string& what) {
    if (!accepted) throw Error(ErrorKind::runtime, fmt::format("HDF5 cannot build {} (out of memory?)", what));
}

// The library may crash on damaged files, whose old format has no checksums. It neither reads nor keeps what follows
// the end of its own data, so that a hash can stand there: a damaged file is known before the library sees it, and a
// file that another program changed has none.
constexpr std::string_view seal_label = "\npatina-fnv1a-64 ";
std::string seal_of(std::uint64_t hash) {
    return fmt::format("{}{:016x}\n", seal_label, hash);
}

Handle text_type() {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
}

Handle new_memory_file() {
    // The image grows in steps of a MiB and is never written by the library itself, whose state a full disk upsets. The
    // earliest format is kept: H5Fget_file_image of HDF5 1.10 leaves a wrong checksum in later superblocks.
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fapl_core(access, std::size_t{1} << 20, false);
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    return {H5Fcreate("table.h5", H5F_ACC_TRUNC, creation, access), H5Fclose};
}

}  // namespace

Session::Session() : lock_(library_mutex()) {
    // Every file is closed by its handle; a damaged one may leave objects that the library's clean-up at exit trips
    // over.
    H5dont_atexit();
    H5Eget_auto2(H5E_DEFAULT, &handler_, &client_data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Session::~Session() {
    H5Eset_auto2(H5E_DEFAULT, handler_, client_data_);
}

Writer::Writer() : file_(new_memory_file()) {
    require(static_cast<bool>(file_), "a file in memory");
}

Handle Writer::open(const std::string& object) const {
    return {H5Oopen(file_, object.c_str(), H5P_DEFAULT), H5Oclose};
}

void Writer::dataset(const std::string& name, const Shape& shape, std::span<const double> values,
                     const DatasetOptions& options) {
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (!options.chunk.empty()) {
        H5Pset_chunk(creation, static_cast<int>(options.chunk.size()), options.chunk.data());
        H5Pset_shuffle(creation);
        H5Pset_deflate(creation, options.compression_level);
    }
    const hid_t type = options.single_precision ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    const Handle dataset(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
    require(dataset && H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, name);
}

void Writer::dataset(const std::string& name, std::span<const std::string> values) {
    std::vector<const char*> texts;
    for (const std::string& value : values) texts.push_back(value.c_str());
    const hsize_t count = texts.size();
    const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose), type = text_type();
    const Handle dataset(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    require(dataset && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()) >= 0, name);
}

void Writer::group(const std::string& name) {
    const Handle group(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    require(static_cast<bool>(group), name);
}

void Writer::attribute(const std::string& object, const std::string& name, const std::string& value) {
    const Handle owner = open(object), space(H5Screate(H5S_SCALAR), H5Sclose), type = text_type();
    const Handle attribute(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const char* text = value.c_str();
    require(attribute && H5Awrite(attribute, type, &text) >= 0, object + "@" + name);
}

void Writer::attribute(const std::string& object, const std::string& name, int value) {
    const Handle owner = open(object), space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(owner, name.c_str(), H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    require(attribute && H5Awrite(attribute, H5T_NATIVE_INT, &value) >= 0, object + "@" + name);
}

void Writer::make_scale(const std::string& name) {
    const Handle scale = open(name);
    require(scale && H5DSset_scale(scale, name.c_str() + (name.front() == '/' ? 1 : 0)) >= 0, name);
}

void Writer::attach_scales(const std::string& name, const std::vector<std::string>& scales,
                           const std::vector<std::string>& labels) {
    PATINA_EXPECT(scales.size() == labels.size());
    const Handle dataset = open(name);
    for (unsigned axis = 0; axis < scales.size(); ++axis) {
        const Handle scale = open(scales[axis]);
        require(dataset && scale && H5DSattach_scale(dataset, scale, axis) >= 0 &&
                    H5DSset_label(dataset, axis, labels[axis].c_str()) >= 0,
                name);
    }
}

std::string Writer::image() {
    require(H5Fflush(file_, H5F_SCOPE_LOCAL) >= 0, "the file");
    const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
    require(size > 0, "the file");
    std::string bytes(static_cast<std::size_t>(size), '\0');
    require(H5Fget_file_image(file_, bytes.data(), bytes.size()) == size, "the file");
    Fingerprint fingerprint;
    fingerprint.add(bytes);
    return bytes + seal_of(fingerprint.value());
}

namespace {

// Throws for a sealed file whose bytes are not those that were written. A file without a seal is another program's.
void check_seal(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::string expected = seal_of(0);
    stream.seekg(0, std::ios::end);
    const std::streamoff size = stream.tellg(), length = size - static_cast<std::streamoff>(expected.size());
    if (length < 0) return;
    std::string seal(expected.size(), '\0');
    stream.seekg(length);
    stream.read(seal.data(), std::ssize(seal));
    if (!stream || !seal.starts_with(seal_label)) return;

    stream.seekg(0);
    Fingerprint fingerprint;
    std::string block(std::size_t{1} << 20, '\0');
    for (std::streamoff left = length; left > 0 && stream; left -= stream.gcount()) {
        stream.read(block.data(), std::min<std::streamoff>(left, std::ssize(block)));
        fingerprint.add(std::string_view(block).substr(0, static_cast<std::size_t>(stream.gcount())));
    }
    if (seal != seal_of(fingerprint.value()))
        throw input_error({path}, "the file is damaged", "its bytes are not those that were written",
                          "make it again, or take it from a backup");
}

Handle open_file(const std::string& path) {
    // Name what is wrong with a path before the library sees it.
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) throw input_error({path}, "file not found");
    if (!std::filesystem::is_regular_file(path, ignored)) throw input_error({path}, "not a regular file");
    check_seal(path);
    Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file)
        throw input_error({path}, "not a readable HDF5 file", "it is of another format, truncated or not permitted");
    return file;
}

}  // namespace

Reader::Reader(const std::filesystem::path& path) : path_(path.string()), file_(open_file(path_)) {}

void Reader::fail(const std::string& object, const std::string& problem, const std::string& why) const {
    throw input_error({path_}, fmt::format("{} {}", object, problem), why);
}

bool Reader::has(const std::string& object) const {
    return H5Lexists(file_, object.c_str(), H5P_DEFAULT) > 0;
}

bool Reader::has_attribute(const std::string& object, const std::string& name) const {
    return H5Aexists_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::string Reader::text_attribute(const std::string& object, const std::string& name) const {
    const std::string label = fmt::format("attribute \"{}\" of {}", name, object);
    const Handle attribute(H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!attribute) fail(label, "is missing");
    const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
    if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) fail(label, "is not a text");

    if (H5Tis_variable_str(type) > 0) {
        char* text = nullptr;
        if (H5Aread(attribute, type, &text) < 0 || text == nullptr) fail(label, "cannot be read");
        std::string result(text);
        H5free_memory(text);
        return result;
    }
    const std::size_t size = H5Tget_size(type);
    if (size > longest_text) fail(label, fmt::format("claims {} bytes", size));
    std::string text(size, '\0');
    if (H5Aread(attribute, type, text.data()) < 0) fail(label, "cannot be read");
    return text.substr(0, text.find('\0'));
}

int Reader::int_attribute(const std::string& object, const std::string& name) const {
    const std::string label = fmt::format("attribute \"{}\" of {}", name, object);
    const Handle attribute(H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!attribute) fail(label, "is missing");
    const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
    int value = 0;
    if (H5Tget_class(type) != H5T_INTEGER || H5Sget_simple_extent_npoints(space) != 1 ||
        H5Aread(attribute, H5T_NATIVE_INT, &value) < 0)
        fail(label, "is not an integer");
    return value;
}

Reader::Numbers Reader::numbers(const std::string& name, std::size_t rank) const {
    const Handle dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset) fail("dataset " + name, "is missing");
    const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
    const H5T_class_t kind = H5Tget_class(type);
    if (kind != H5T_FLOAT && kind != H5T_INTEGER) fail("dataset " + name, "does not hold numbers");

    const int found_rank = H5Sget_simple_extent_ndims(space);
    if (found_rank != static_cast<int>(rank))
        fail("dataset " + name, fmt::format("has {} dimensions", found_rank), fmt::format("{} are expected", rank));
    Numbers result{Shape(rank), {}};
    H5Sget_simple_extent_dims(space, result.shape.data(), nullptr);
    hsize_t count = 1;
    for (hsize_t extent : result.shape) {
        if (extent == 0) fail("dataset " + name, "is empty");
        if (extent > largest_value_count / count) fail("dataset " + name, "is larger than any table");
        count *= extent;
    }

    std::error_code ignored;
    const std::uintmax_t bytes = std::filesystem::file_size(path_, ignored);
    if (count / largest_expansion > bytes) fail("dataset " + name, "is larger than its file can hold");

    result.values.resize(count);
    if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.values.data()) < 0)
        fail("dataset " + name, "cannot be read", "the file is damaged or truncated");
    return result;
}

}  // namespace patina::io::hdf5
