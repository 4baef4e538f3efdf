#pragma once
// Contracts: what the programmer promised. A broken one is a defect of Patina, never of the user's input.
//
// PATINA_EXPECT states a precondition, PATINA_ENSURE a postcondition; both stay on in the builds that are tested
// (PATINA_CONTRACTS). PATINA_ASSERT is for inner loops and is on in debug builds only.

#include <stdexcept>
#include <string>

namespace patina {

class ContractViolation : public std::logic_error {
  public:
    ContractViolation(const char* kind, const char* condition, const char* file, int line)
        : std::logic_error(std::string(file) + ":" + std::to_string(line) + ": " + kind + " broken: " + condition) {}
};

}  // namespace patina

#define PATINA_CONTRACT_CHECK(kind, condition) \
    ((condition) ? static_cast<void>(0) : throw ::patina::ContractViolation(kind, #condition, __FILE__, __LINE__))

#if PATINA_CONTRACTS
#define PATINA_EXPECT(condition) PATINA_CONTRACT_CHECK("precondition", condition)
#define PATINA_ENSURE(condition) PATINA_CONTRACT_CHECK("postcondition", condition)
#else
#define PATINA_EXPECT(condition) static_cast<void>(0)
#define PATINA_ENSURE(condition) static_cast<void>(0)
#endif

#ifndef NDEBUG
#define PATINA_ASSERT(condition) PATINA_CONTRACT_CHECK("assertion", condition)
#else
#define PATINA_ASSERT(condition) static_cast<void>(0)
#endif
