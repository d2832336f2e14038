/* sRGB codes and their linear values, as tables: IEC 61966-2-1, the curve that spec/math/srgb.h cites.
 *
 * The tables were computed with 50 digits. tests/base/srgb.c computes them again. */
#ifndef BASE_SRGB_H
#define BASE_SRGB_H

struct srgb_tables {
    float decoded[256]; /* the linear value of the code, rounded to nearest */
    float least[257];   /* the least linear value that rounds to the code; of 256, infinity */
};

extern const struct srgb_tables srgb_tables;

#endif
