#pragma once
// Mitsuba 3 scene files (https://mitsuba.readthedocs.io, "Scene XML file format") as property trees.
//
// The reader knows the grammar and no plugin: which bsdf or shape types exist is the renderer's business. It handles
// <default> and $name, <include>, <path>, <alias>, ids and <ref>, all property elements and all plugin elements.
//
// - The root's category and type are "scene"; a child's category is its tag, its type the attribute `type`.
// - A <ref> becomes a child holding the very node it names, which may come later in the file.
// - Properties named filename, recipe and table name a file: the value becomes the absolute path of an existing file,
// looked for
//   beside the file that names it, beside the scene, and in the folders of <path>. It is an error when there is none.
//   A `material` becomes a path only when such a file exists, for it may also be the name of a built-in material.
// - <spectrum filename="x.spd"> is read here and becomes a sampled spectrum.
//
// - An <animation> of transforms becomes a child of category "animation" (mitsuba_values.h).
//
// Not supported, and refused by name: Mitsuba 0.x files (camelCase, version 0.6).

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "patina/core/properties.h"

namespace patina::io {

// `parameters` replace the file's <default> values; one the scene never asks for is an error.
// Throws Error(input) with file, line and column for anything that is not a scene; never recurses without bound.
std::shared_ptr<const Properties> read_mitsuba_scene(const std::filesystem::path& path,
                                                     const std::map<std::string, std::string>& parameters = {});

// The same for text at hand; `path` stands in messages and its folder is where relative file names start.
std::shared_ptr<const Properties> parse_mitsuba_scene(std::string text, const std::filesystem::path& path,
                                                      const std::map<std::string, std::string>& parameters = {});

}  // namespace patina::io
