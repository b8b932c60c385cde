// PB_VECTOR_CLONES before a function compiles it for every x86-64 machine, for AVX2 and for AVX-512, chosen when the
// program is loaded. Contraction to fused multiply-add is off and loops over rows have no sums across their elements,
// so all give the same bits.
#pragma once

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__)
#define PB_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define PB_VECTOR_CLONES
#endif
