// Pixel loops in the widest registers that the processor has.
#ifndef EYEBOX_CAPTURE_BASE_VECTORISE_H_
#define EYEBOX_CAPTURE_BASE_VECTORISE_H_

// Before a function whose loops should be compiled twice, the better one being chosen when the
// program is loaded. The results are the same to the bit: neither form contracts a product and a
// sum, and sums of floating-point numbers keep their order. Sanitizers cannot bear the choice
// being made before they have begun.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define EYEBOX_VECTORISE __attribute__((target_clones("avx2", "default")))
#else
#define EYEBOX_VECTORISE
#endif

#endif  // EYEBOX_CAPTURE_BASE_VECTORISE_H_
