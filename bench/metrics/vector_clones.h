// PB_VECTOR_CLONES before a function compiles it once for every x86-64 machine and once with AVX2, chosen when the
// program is loaded. AVX2 does not include fused multiply-add and contraction is off, so both give the same bits.
#pragma once

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__)
#define PB_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define PB_VECTOR_CLONES
#endif
