#pragma once
// How the process asks the system for memory.

namespace patina {

// Keeps memory that is freed for the next to come, instead of giving it back to the system and asking again: matrices
// of some hundred kilobytes come and go by the thousand, and fresh pages cost a quarter of a solution. For a program's
// start; does nothing where the C library is not GNU's.
void keep_freed_memory();

}  // namespace patina
