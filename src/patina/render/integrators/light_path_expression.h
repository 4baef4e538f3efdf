#pragma once
// Light-path expressions: regular expressions over the events of a path, as one finite automaton for any number of
// them.
//
// Heckbert (1990), Adaptive radiosity textures for bidirectional ray tracing: L light, E eye, D diffuse, G glossy,
// S specular (scattering_event.h); concatenation, | or, * any number, + one or more, ? one or none, ( ) or [ ]
// grouping; here also V for scattering in a medium and . for any
// of D, G, S, V. Blanks are skipped. An expression is written from the light, L(S|D)+DE, or
// from the eye, ED+(S|D)L; both ends must be there. Each symbol becomes a position of a nondeterministic automaton
// without empty moves (Glushkov 1961), and the positions of all expressions together are made deterministic by subsets
// (Rabin & Scott 1959).

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "patina/render/integrators/scattering_event.h"

namespace patina::render {

struct LightPathExpression {
    std::string name;  // of the picture it selects
    std::string text;
};

// Reads a path from the eye to the light, event by event. Paths that exactly the same expressions accept share a class.
class LightPathClassifier {
  public:
    LightPathClassifier() : LightPathClassifier(std::span<const LightPathExpression>{}) {}
    // Throws Error(usage), with the column in the expression, for what is no expression or begins and ends wrongly.
    explicit LightPathClassifier(std::span<const LightPathExpression> expressions);

    static constexpr int eye = 0;  // the state of a path that has only its eye
    int after(int state, ScatteringEvent event) const { return states_[state].next[static_cast<int>(event)]; }
    // Class of the path that meets the light in this state.
    int path_class(int state) const { return states_[state].path_class; }

    int class_count() const { return static_cast<int>(members_.size()); }
    // Do the paths of a class belong to the expression?
    bool belongs(int path_class, int expression) const { return members_[path_class][expression]; }

  private:
    struct State {
        int next[scattering_events] = {};
        int path_class = 0;
    };
    std::vector<State> states_;
    std::vector<std::vector<bool>> members_;  // [class][expression]
};

}  // namespace patina::render
