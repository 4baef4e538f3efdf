#pragma once
// The one exception type for everything a user can get wrong or a machine can refuse.
//
// A message reads `where: problem (why); suggestion`. It is caught at the walls of the program only (command line, and
// later HTTP, Python, MPI). Mistakes of the programmer are contracts (core/contract.h), not errors.

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace patina {

// What went wrong, in the terms of the exit codes of the command line.
enum class ErrorKind {
    runtime = 1,       // the machine refused: disk full, file not writable
    usage = 2,         // the command line makes no sense
    input = 3,         // a file or a value given by the user is wrong
    check = 4,         // a check failed, or a solution did not converge
    not_built = 5,     // a feature this build does not have
    interrupted = 130  // the user stopped it
};

// A place in a user's file; line and column count from 1, and 0 means "not known".
struct SourceLocation {
    std::string file;
    int line = 0;
    int column = 0;

    // "file:line:column", leaving out what is not known.
    std::string to_string() const;
};

class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, std::string message) : std::runtime_error(std::move(message)), kind_(kind) {}
    ErrorKind kind() const { return kind_; }

  private:
    ErrorKind kind_;
};

// `where: problem (why); suggestion`; empty parts are left out; a SourceLocation{} has no place.
Error input_error(const SourceLocation& where, std::string_view problem, std::string_view why = {},
                  std::string_view suggestion = {});

// `did you mean "x"?` for the candidate nearest to `word` in edit distance, or "" when none is near;
// with `list_all`, the candidates themselves are listed when none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates, bool list_all = true);

}  // namespace patina
