# Flags every target shares. They must be the same everywhere: Eigen's alignment, hence the ABI, depends on the instruction set.
set(PATINA_SANITIZE "" CACHE STRING "Sanitizers, comma separated")

add_library(patina_flags INTERFACE)
target_compile_options(patina_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wno-missing-field-initializers)
# GCC 12 warns in its own AVX-512 header (GCC bug 105593).
target_compile_options(patina_flags INTERFACE -Wno-maybe-uninitialized -Wno-uninitialized)
if(PATINA_NATIVE)
  target_compile_options(patina_flags INTERFACE -march=native)
endif()
if(PATINA_CONTRACTS)
  target_compile_definitions(patina_flags INTERFACE PATINA_CONTRACTS=1)
endif()
if(PATINA_SANITIZE)
  target_compile_options(patina_flags INTERFACE -fsanitize=${PATINA_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  target_link_options(patina_flags INTERFACE -fsanitize=${PATINA_SANITIZE})
endif()
# mold 1.10 does not know GCC's intermediate files, which this project does not use.
find_program(PATINA_MOLD mold)
if(PATINA_MOLD)
  target_link_options(patina_flags INTERFACE -fuse-ld=mold)
endif()
# Parallelism is ours (oneTBB); a second pool under Eigen would fight it.
target_compile_definitions(patina_flags INTERFACE EIGEN_DONT_PARALLELIZE EIGEN_MPL2_ONLY)
