#pragma once

// UAV_LANDING_MULTIVERSION before a function's definition compiles it twice, for plain x86-64 and for AVX2,
// and the loader chooses by the processor. Without FMA on purpose: both give the same bits. For loops that
// the compiler vectorises, out of line and without calls of functions that are not inlined. The sanitizers'
// runtimes are not there yet when the loader chooses, so their builds have the plain form only, as have other
// compilers and processors.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define UAV_LANDING_MULTIVERSION __attribute__((target_clones("avx2", "default")))
#else
#define UAV_LANDING_MULTIVERSION
#endif

// Before a loop of few instructions over many pixels: does four vectors in turn, as counting and jumping back
// is a good part of such a loop.
#if defined(__GNUC__) && !defined(__clang__)
#define UAV_LANDING_UNROLL _Pragma("GCC unroll 4")
#else
#define UAV_LANDING_UNROLL
#endif
