/* The floating-point environment of the numeric contract: round to nearest even, FTZ, DAZ, exceptions masked.
 *
 * Source: Intel SDM volume 1, 10.2.3. Every routine sets it on entry and restores the caller's. */
#ifndef MACHINE_MXCSR_H
#define MACHINE_MXCSR_H

#include <xmmintrin.h>

enum { MXCSR_CONTRACT = 0x9fc0 }; /* FTZ | all masks | DAZ, rounding 00 */

static inline unsigned mxcsr_enter(void)
{
    unsigned saved = _mm_getcsr();
    _mm_setcsr(MXCSR_CONTRACT);
    return saved;
}

static inline void mxcsr_leave(unsigned saved)
{
    _mm_setcsr(saved);
}

#endif
