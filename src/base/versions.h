/* versions.h -- compile a loop for several instruction sets; the program chooses one when it starts. */
#ifndef VERSIONS_H
#define VERSIONS_H


#if defined(__GNUC__) && !defined(__clang__)
#define FAST __attribute__((optimize("O3")))
#define UNROLL _Pragma("GCC unroll 8")
#else
#define FAST
#define UNROLL
#endif

/* A function for machines of one kind.  It may fuse multiplications with additions: last bits differ from
 * those of other kinds.  BEST_VERSION is the one of three such functions that is for this machine. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define HAVE_TARGETS
#define FAST_FOR(kind) __attribute__((target(kind), optimize("O3", "fp-contract=fast")))
#define BEST_VERSION(any, avx2_fma, avx512) \
    (__builtin_cpu_supports("avx512f") ? (avx512) \
     : __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? (avx2_fma) : (any))
#else
#define BEST_VERSION(any, avx2_fma, avx512) (any)
#endif

/* A function that is compiled for several kinds, where compiler and C library support that, and no
 * sanitizer runs before its own start.  Before GCC 10 the choice among them is a name that the shared
 * library shows.  None of them fuses: the result is the same on all. */
#if defined(HAVE_TARGETS) && defined(__GLIBC__) && __GNUC__ >= 10 \
    && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define VERSIONS __attribute__((target_clones("default", "avx2", "avx512f"), optimize("O3")))
#else
#define VERSIONS FAST
#endif

#endif
