/* Values of the fields of the blit key. */
#ifndef CONTRACT_KEY_BLIT_H
#define CONTRACT_KEY_BLIT_H

/* The operation of a blit routine (spec/blit/blit.h). */
enum blit_operation { BLIT_CLEAR, BLIT_RESOLVE, BLIT_SHRINK, BLIT_BLEND, BLIT_COUNT };

/* The bytes of a word that a clear sets: bit 0 is the lowest. BLIT_MASK_JOB: bits that the job selects. */
enum { BLIT_MASK_ALL = 15, BLIT_MASK_JOB = 16, BLIT_MASKS = 17 };

/* A texel of the smaller level covers up to three texels along each of three axes. */
enum { BLIT_AXES = 3, BLIT_TAPS_MAXIMUM = 3, BLIT_ROWS = BLIT_TAPS_MAXIMUM * BLIT_TAPS_MAXIMUM };

#endif
