#pragma once
// A recipe at a list of wavelengths, set up once, with one layer of variable thickness over any base.

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "patina/coating/recipe.h"
#include "patina/core/progress.h"
#include "patina/rt/solver.h"

namespace patina::coating {

// Reflectance factors (1 for the perfect reflecting diffuser) for unpolarized light, one value a wavelength, in the
// geometries of instruments. With an index-matched top, directions are those in the host and nothing is specular.
struct ReflectanceSpectra {
    std::vector<double> r45_0;        // 45:0, light at 45 degrees all around, seen along the normal; no specular light
    std::vector<double> d8_excluded;  // d:8, diffuse light, seen at 8 degrees; specular reflection left out
    std::vector<double> d8_included;  // the same with the reflection of the surface (and of a metal base)
    std::vector<double> bihemispherical;  // d:d, diffuse in, all out; specular reflection left out
};

// What stacks of one series have been asked already: a sweep over thickness asks again for the infinite layer, for the
// film that hides and for the film's coefficients, one over the base for all but the own base. Answers are found by
// everything they depend on, so that they are the very bits a stack without memory gives.
class StackMemory {
  public:
    struct SetUp {
        std::string composition;  // see StackOptions
        std::vector<rt::Problem> problems;
        std::vector<std::string> notes;
    };

    const ReflectanceSpectra* answer(std::uint64_t question) const;
    void keep(std::uint64_t question, const ReflectanceSpectra& answer);
    // Of the last composition.
    const SetUp* set_up(const std::string& composition) const;
    const SetUp& keep(SetUp set_up) { return set_up_ = std::move(set_up); }

    std::size_t answers_found() const { return found_; }

  private:
    std::map<std::uint64_t, ReflectanceSpectra> answers_;
    SetUp set_up_;
    mutable std::size_t found_ = 0;
};

struct StackOptions {
    std::vector<double> wavelengths_nm;  // ascending, at least one
    double tolerance = 1e-3;             // relative, of reflectances
    int streams = 0;                     // 0 = from the tolerance
    std::string solver = "doubling";
    std::shared_ptr<StackMemory> memory;  // shared by the stacks of a series, one at a time; may be null
    // Recipes of the same name differ in the thickness of the variable layer alone; empty: not known.
    std::string composition;
};

// The layer whose thickness varies: the topmost that scatters, else the topmost.
struct VariableLayer {
    int index = 0;
    bool scatters = false;
    bool is_optical = false;  // given in optical terms: its thickness is an optical thickness, else in um
};
VariableLayer variable_layer(const Recipe& recipe);

class VariableStack {
  public:
    // Mie and mixing rules run here, once a wavelength. Throws Error(input) for what cannot be solved,
    // Error(interrupted).
    VariableStack(const Recipe& recipe, const StackOptions& options, const JobControl& control = {});

    const std::vector<double>& wavelengths_nm() const { return options_.wavelengths_nm; }
    int streams() const { return streams_; }
    // Are there enough streams for the phase functions as they are, without truncation?
    bool streams_are_exact() const;
    const std::vector<std::string>& notes() const { return notes_; }  // sorted, each once
    bool has_interface() const { return recipe_.has_interface; }

    const VariableLayer& layer() const { return layer_; }
    // Its thickness in the recipe.
    double thickness() const { return thickness_; }
    // Refractive index of its binder at a wavelength.
    double layer_index(int w) const { return problems_[w].layers[layer_.index].refractive_index; }
    // Per unit of thickness: transport scattering coefficient sigma_s (1 - g), and absorption.
    double transport_scattering(int w) const;
    double absorption(int w) const;

    // What lies below the variable layer.
    enum class Below {
        stack,   // the layers of the recipe
        nothing  // the base follows at once
    };
    // What lies above it.
    enum class Above {
        stack,   // the layers of the recipe
        nothing  // it is the topmost
    };
    struct Question {
        std::vector<double> thickness;  // of the variable layer, one a wavelength or one for all; may be infinite
        std::optional<double> lambertian_base;  // in optical contact; nothing: the base of the recipe
        Below below = Below::stack;
        Above above = Above::stack;
    };
    // Wavelengths run in parallel. Throws Error(interrupted) when stopped.
    ReflectanceSpectra solve(const Question& question, const JobControl& control = {}) const;

    bool converged() const { return converged_; }

  private:
    StackMemory::SetUp set_up(const JobControl& control) const;
    rt::Problem problem(int w, const Question& question) const;
    int chosen_streams(const JobControl& control) const;
    ReflectanceSpectra solve(const std::vector<rt::Problem>& problems, int streams, const JobControl& control) const;

    const Recipe& recipe_;
    StackOptions options_;
    const rt::Solver& solver_;
    std::vector<rt::Problem> problems_;       // with unit thickness of the variable layer
    std::vector<double> optical_per_length_;  // optical thickness of the variable layer per unit of thickness
    std::vector<std::string> notes_;
    VariableLayer layer_;
    int streams_ = 0;
    double thickness_ = 0.0;
    mutable std::atomic<bool> converged_ = true;
};

}  // namespace patina::coating
