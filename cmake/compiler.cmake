# One interface target that every target of ours links: warnings as errors, sanitizers, coverage.
add_library(rmac_compiler INTERFACE)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(rmac_compiler INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual
    -Wcast-align -Wduplicated-cond -Wlogical-op -Wnull-dereference -Werror)
  if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
    # g++ 12 reports false null dereferences and overlaps from inlined library code when it optimises: Asio's scheduler, for
    # one, and std::string::replace (GCC bug 105651).
    target_compile_options(rmac_compiler INTERFACE -Wno-null-dereference -Wno-restrict)
  endif()
endif()
# A fused multiply-add would make figures depend on the processor; limits are checked against differences of recorded setpoints.
target_compile_options(rmac_compiler INTERFACE -ffp-contract=off)
if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
  target_compile_options(rmac_compiler INTERFACE -fno-math-errno)
endif()
if(RMAC_SANITIZE)
  target_compile_options(rmac_compiler INTERFACE -fsanitize=${RMAC_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(rmac_compiler INTERFACE -Wno-null-dereference -Wno-maybe-uninitialized)
  endif()
  target_link_options(rmac_compiler INTERFACE -fsanitize=${RMAC_SANITIZE})
  if(RMAC_SANITIZE MATCHES "address" AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    set(RMAC_FUZZ ON)
  endif()
  if(RMAC_SANITIZE MATCHES "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Asio's fences beside its mutexes are what the thread sanitizer does not see; its mutexes order the same accesses.
    target_compile_options(rmac_compiler INTERFACE -Wno-tsan)
  endif()
endif()
# What strangers' bytes come to is instrumented for tests/fuzz. The planner is not: each comparison of numbers would be a call.
function(rmac_is_fuzzed target)
  if(RMAC_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()
if(RMAC_COVERAGE)
  target_compile_options(rmac_compiler INTERFACE --coverage)
  target_link_options(rmac_compiler INTERFACE --coverage)
endif()
find_program(RMAC_CCACHE ccache)
if(RMAC_CCACHE)
  # One checkout finds what another one compiled, by what the compiler said it read: a miss costs no preprocessing. The time that a module
  # tells is when what stands in it was compiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER
    ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 CCACHE_DEPEND=1 CCACHE_SLOPPINESS=time_macros ${RMAC_CCACHE})
endif()
