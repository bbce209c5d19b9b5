#pragma once

// Compiles a function once for each vector width and selects one when the library is loaded. Every clone
// rounds the same products and sums in the same order (CMakeLists.txt disables fused multiply-add), so that
// every computer gives the same tables.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#if __GNUC__ >= 12
#define FSR_EACH_VECTOR_WIDTH __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define FSR_EACH_VECTOR_WIDTH __attribute__((target_clones("avx512f", "avx2", "default")))
#endif
#else
#define FSR_EACH_VECTOR_WIDTH
#endif
