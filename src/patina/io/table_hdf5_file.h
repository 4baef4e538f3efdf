#pragma once
// A thin layer over the C library of HDF5: handles that close themselves, errors that name file and dataset.

#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include <hdf5.h>

namespace patina::io::hdf5 {

// The serial library is not thread safe and prints to stderr: while a Session lives, the caller has the library alone
// and silent.
class Session {
  public:
    Session();
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

  private:
    std::unique_lock<std::mutex> lock_;
    H5E_auto2_t handler_ = nullptr;
    void* client_data_ = nullptr;
};

// An identifier of the library with the function that releases it; negative when the library refused.
class Handle {
  public:
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
    Handle& operator=(Handle&&) = delete;
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    operator hid_t() const { return id_; }
    explicit operator bool() const { return id_ >= 0; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

using Shape = std::vector<hsize_t>;

struct DatasetOptions {
    bool single_precision = false;
    Shape chunk;  // empty: contiguous, not compressed
    unsigned compression_level = 0;
};

// A file built in memory; image() is what belongs on the disk.
class Writer {
  public:
    Writer();
    void dataset(const std::string& name, const Shape& shape, std::span<const double> values,
                 const DatasetOptions& options = {});
    void dataset(const std::string& name, std::span<const std::string> values);
    void group(const std::string& name);
    void attribute(const std::string& object, const std::string& name, const std::string& value);
    void attribute(const std::string& object, const std::string& name, int value);
    // Makes a dataset the scale of its dimension; then fixes such scales, and labels, to the dimensions of another.
    void make_scale(const std::string& name);
    void attach_scales(const std::string& name, const std::vector<std::string>& scales,
                       const std::vector<std::string>& labels);
    std::string image();

  private:
    Handle open(const std::string& object) const;
    Session session_;
    Handle file_;
};

// A file on the disk. Everything missing or of the wrong kind is an Error(input) naming file and object.
class Reader {
  public:
    explicit Reader(const std::filesystem::path& path);
    bool has(const std::string& object) const;
    bool has_attribute(const std::string& object, const std::string& name) const;
    std::string text_attribute(const std::string& object, const std::string& name) const;
    int int_attribute(const std::string& object, const std::string& name) const;

    struct Numbers {
        Shape shape;
        std::vector<double> values;  // C order
    };
    // A numeric dataset of the given rank.
    Numbers numbers(const std::string& name, std::size_t rank) const;

    [[noreturn]] void fail(const std::string& object, const std::string& problem, const std::string& why = {}) const;

  private:
    std::string path_;
    Session session_;
    Handle file_;
};

}  // namespace patina::io::hdf5
