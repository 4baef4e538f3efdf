#pragma once
// Results of a long job on disk as soon as they are finished, so that a job that was stopped, or killed, goes on where
// it was. Layout: docs/formats/solve_checkpoint.md.

#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace patina::jobs {

class Checkpoint {
  public:
    // What the results depend on: name and value, as people would say it.
    using Identity = std::vector<std::pair<std::string, std::string>>;

    // Keeps nothing and finds nothing.
    Checkpoint() = default;
    // Starts a new file, or with `resume` goes on with the one that is there, if any; a record cut short by a kill is
    // dropped. Throws Error(input) when that file is none of this program's or its identity differs, Error(runtime)
    // when it cannot be written.
    Checkpoint(const std::filesystem::path& path, const Identity& identity, bool resume);

    // A result kept earlier. `count` (0: any) is the number of values it must have.
    std::optional<std::vector<double>> find(const std::string& key, std::size_t count = 0) const;
    // Keeps a result; returns once it would survive the death of the program. Thread-safe.
    void add(const std::string& key, std::span<const double> values);

    std::size_t found_at_start() const { return found_.size(); }
    // The job is done and its result is written: the file goes.
    void remove();

  private:
    void read(const Identity& identity);
    void append(std::string_view bytes);

    std::filesystem::path path_;
    std::ofstream stream_;
    std::mutex mutex_;
    std::map<std::string, std::vector<double>> found_;
};

}  // namespace patina::jobs
