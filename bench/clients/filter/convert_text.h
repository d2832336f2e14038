/* The text of the conversion, for a binding: four pixels of a row in each lane. */
#ifndef CLIENTS_FILTER_CONVERT_TEXT_H
#define CLIENTS_FILTER_CONVERT_TEXT_H

#include "contract/language.h"

#include "bench/clients/filter/convert.h"

/* Byte `number` of a word, as an integer. */
static inline itg convert_byte(struct env *e, itg word, int number)
{
    if (number == 3)
        return ushr_i(E, word, 24);
    itg shifted = number ? ushr_i(E, word, 8 * number) : word;
    return and_i(E, shifted, lit_i(E, 255));
}

/* The share of chroma in the three channels, with the offset. u and v are the halves of a word, and a
 * multiplication of halves with a sum is one operation. */
static inline void convert_chroma(struct env *e, const struct convert_factors *f, itg u, itg v, itg sum[3])
{
    itg high = shl_i(E, v, 16);
    itg both = or_i(E, u, high);
    for (int channel = 0; channel < 3; channel++) {
        uint32_t factors = (uint16_t)f->u[channel] | (uint32_t)(uint16_t)f->v[channel] << 16;
        itg factor = lit_i(E, (int32_t)factors);
        itg product = dot_i(E, both, factor);
        sum[channel] = add_i(E, product, lit_i(E, f->offset[channel]));
    }
}

static inline itg convert_channel(struct env *e, itg luma, itg chroma)
{
    itg sum = add_i(E, luma, chroma);
    itg value = shr_i(E, sum, CONVERT_BITS);
    itg positive = max_i(E, value, lit_i(E, 0));
    return min_i(E, positive, lit_i(E, 255));
}

static inline itg convert_pixel(struct env *e, const struct convert_choice *choice,
                                const struct convert_factors *f, itg y, const itg chroma[3])
{
    itg pixel = lit_i(E, (int32_t)(255u << 8 * choice->place[3]));
    itg luma = dot_i(E, y, lit_i(E, f->luma));
    for (int channel = 0; channel < 3; channel++) {
        itg value = convert_channel(E, luma, chroma[channel]);
        itg placed = shl_i(E, value, 8 * choice->place[channel]);
        pixel = or_i(E, pixel, placed);
    }
    return pixel;
}

/* INPUT has the number of the element in its row. An element has 4, 2 or 1 samples of chroma. */
static inline void convert_text(struct env *e, const struct convert_choice *choice)
{
    const struct convert_factors f = convert_factors(choice);
    const int scale = 4 / choice->across;
    itg element = load_i(E, BASE_INPUT, 0);
    itg luma = gather_i(E, BASE_JOB, (int)offsetof(struct convert_job, y), element, 4, 0);
    itg blue = gather_i(E, BASE_JOB, (int)offsetof(struct convert_job, u), element, scale, 0);
    itg red = gather_i(E, BASE_JOB, (int)offsetof(struct convert_job, v), element, scale, 0);
    itg chroma[3], pixel[4];
    for (int i = 0; i < 4; i++) {
        if (i % choice->across == 0) {
            itg u = convert_byte(E, blue, i / choice->across);
            itg v = convert_byte(E, red, i / choice->across);
            convert_chroma(E, &f, u, v, chroma);
        }
        itg y = convert_byte(E, luma, i);
        pixel[i] = convert_pixel(E, choice, &f, y, chroma);
    }
    for (int i = 0; i < 4; i++)
        scatter_i(E, BASE_OUTPUT, 4 * i, CONVERT_STRIDE, pixel[i]);
}

#endif
