#pragma once

// UAV_LANDING_MULTIVERSION before a function's definition compiles it twice, for plain x86-64 and for AVX2.
// The loader chooses by the processor. FMA is not used, so that both give the same bits. It suits loops that
// the compiler vectorises; the function must stay out of line and call no function that is not inlined.
// Builds with sanitizers have the plain form only, because their runtimes are not ready when the loader
// chooses. Other compilers and processors have it, too.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define UAV_LANDING_MULTIVERSION __attribute__((target_clones("avx2", "default")))
#else
#define UAV_LANDING_MULTIVERSION
#endif

// Put it before a loop of few instructions over many pixels. Each turn then works on four vectors, as
// counting and jumping back would take much of the time.
#if defined(__GNUC__) && !defined(__clang__)
#define UAV_LANDING_UNROLL _Pragma("GCC unroll 4")
#else
#define UAV_LANDING_UNROLL
#endif
