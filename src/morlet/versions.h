/* versions.h -- hot loops for what the machine has, decided when the program starts. */
#ifndef VERSIONS_H
#define VERSIONS_H

#include <stdlib.h>             /* for __GLIBC__ */

/* Where compiler and C library support that, and no sanitizer runs before its own start.  None has
 * fused multiply-add: the result is the same. */
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) \
    && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define VERSIONS __attribute__((target_clones("default", "avx2", "avx512f"), optimize("O3")))
#else
#define VERSIONS
#endif

#endif
