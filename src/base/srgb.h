/* sRGB codes and what they stand for, as tables: IEC 61966-2-1, the curve that spec/srgb.h cites.
 *
 * Computed with 50 digits; tests/base/srgb.c computes them again. */
#ifndef BASE_SRGB_H
#define BASE_SRGB_H

struct srgb_tables {
    float decoded[256]; /* the nearest binary32 */
    float least[257];   /* the least binary32 whose encoding rounds to the code; of 256, infinity */
};

extern const struct srgb_tables srgb_tables;

#endif
