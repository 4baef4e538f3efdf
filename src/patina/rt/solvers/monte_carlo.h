#pragma once
// "montecarlo": polarized Monte Carlo of the stack, the solver to doubt the deterministic ones with.
//
// Packets with explicit electric-field frames walk through the stack (monte_carlo/walk.h); no Fourier modes, no
// operators. It does every Problem: several layers, refraction wherever indices differ, black, Lambertian and metal
// bases, infinite lowest layer, any albedo. Every value has a statistical error ~ 1/sqrt(SolveOptions::samples);
// field() returns it, from batch means. Systematic errors: linear interpolation of F between at least 2048 angles a
// hemisphere, and 1e-6 for a nearly conservative infinite layer (stack.h). The time of a packet grows like the optical
// thickness where nothing absorbs. Field directions with mu_o = 0 are refused.

#include <memory>

#include "patina/rt/solver.h"

namespace patina::rt {

std::unique_ptr<Solver> make_monte_carlo_solver();

}  // namespace patina::rt
