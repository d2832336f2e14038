/* The text of the cipher, for a binding: one block in each lane. */
#ifndef CLIENTS_CIPHER_CHACHA_TEXT_H
#define CLIENTS_CIPHER_CHACHA_TEXT_H

#include "contract/language.h"

#include "bench/clients/cipher/chacha.h"

static inline itg chacha_word(struct env *e, const struct chacha_choice *choice, int word)
{
    if (choice->fixed || word < 4)
        return lit_i(E, (int32_t)choice->state[word]);
    return uniform_i(E, BASE_JOB, (int)offsetof(struct chacha_job, state) + 4 * word);
}

/* a += b, d = (d ^ a) rotated by k bits to the left: half of half a quarter round. */
static inline void chacha_mix(struct env *e, itg *a, itg b, itg *d, int k)
{
    itg sum = add_i(E, *a, b);
    itg mixed = xor_i(E, *d, sum);
    *a = sum;
    *d = rotl_i(E, mixed, k);
}

static inline void chacha_quarter(struct env *e, itg *a, itg *b, itg *c, itg *d)
{
    chacha_mix(E, a, *b, d, 16);
    chacha_mix(E, c, *d, b, 12);
    chacha_mix(E, a, *b, d, 8);
    chacha_mix(E, c, *d, b, 7);
}

static inline void chacha_double_round(struct env *e, itg x[CHACHA_WORDS])
{
    for (int i = 0; i < 4; i++)
        chacha_quarter(E, x + i, x + 4 + i, x + 8 + i, x + 12 + i);
    for (int i = 0; i < 4; i++)
        chacha_quarter(E, x + i, x + 4 + (i + 1) % 4, x + 8 + (i + 2) % 4, x + 12 + (i + 3) % 4);
}

/* INPUT has the number of the block, from 0 on; blocks of message and output are consecutive. */
static inline void chacha_text(struct env *e, const struct chacha_choice *choice)
{
    itg start[CHACHA_WORDS], x[CHACHA_WORDS];
    itg block = load_i(E, BASE_INPUT, 0);
    for (int i = 0; i < CHACHA_WORDS; i++)
        start[i] = chacha_word(E, choice, i);
    start[CHACHA_COUNTER] =
        uniform_i(E, BASE_JOB, (int)offsetof(struct chacha_job, state) + 4 * CHACHA_COUNTER);
    start[CHACHA_COUNTER] = add_i(E, start[CHACHA_COUNTER], block);
    for (int i = 0; i < CHACHA_WORDS; i++)
        x[i] = start[i];
    for (int round = 0; round < choice->rounds; round += 2)
        chacha_double_round(E, x);
    itg eighth = shl_i(E, block, 3); /* a gather multiplies by 8 */
    for (int i = 0; i < CHACHA_WORDS; i++)
        x[i] = add_i(E, x[i], start[i]);
    for (int i = 0; i < CHACHA_WORDS; i += 4) {
        itg message[4];
        for (int w = 0; w < 4; w++)
            message[w] =
                gather_i(E, BASE_JOB, (int)offsetof(struct chacha_job, message), eighth, 8, 4 * (i + w));
        for (int w = 0; w < 4; w++)
            message[w] = xor_i(E, message[w], x[i + w]);
        for (int w = 0; w < 4; w++)
            scatter_i(E, BASE_OUTPUT, 4 * (i + w), CHACHA_BLOCK, message[w]);
    }
}

#endif
