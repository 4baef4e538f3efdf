#pragma once
// The state of a render in a file, so that a stopped render goes on to the bits it would have had without the stop.
//
// The file is of the machine that wrote it: a line that says what it is, the length of a JSON document (8 bytes), the
// document (samples done; everything that decides the picture; sizes of the films), the films, and a hash of all of it.

#include <filesystem>
#include <map>
#include <string>

#include "patina/brdf/mueller_table.h"
#include "patina/core/fingerprint.h"
#include "patina/core/properties.h"
#include "patina/render/render.h"

namespace patina::jobs {

// A scene: every name and value; of the files it names their content, not their place.
void add_to(Fingerprint& fingerprint, const Properties& node);
void add_to(Fingerprint& fingerprint, const brdf::MuellerTable& table);

// What decides a picture, in words, by what the user calls it.
using RenderIdentity = std::map<std::string, std::string>;

// How the options stand in the identity.
void add_options(const render::RenderOptions& options, RenderIdentity& identity);

class CheckpointFile {
  public:
    CheckpointFile(std::filesystem::path path, RenderIdentity identity)
        : path_(std::move(path)), identity_(std::move(identity)) {}

    // Written under a temporary name and renamed. Throws Error(runtime) when the disk refuses.
    void save(const render::RenderState& state) const;
    // False: there is no such file. Throws Error(input) for a damaged file and for one of another picture, naming the
    // first difference.
    bool load(render::RenderState& state) const;
    // Removes the file, if there is one.
    void remove() const;

  private:
    std::filesystem::path path_;
    RenderIdentity identity_;
};

}  // namespace patina::jobs
