#pragma once
// What the solution of a problem depends on, in short.

#include "patina/core/fingerprint.h"
#include "patina/rt/problem.h"

namespace patina::rt {

// Adds every number of the problem.
void add_to(Fingerprint& fingerprint, const Problem& problem);

}  // namespace patina::rt
