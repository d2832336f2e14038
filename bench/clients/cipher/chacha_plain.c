/* ChaCha20 in plain C, one block after the other, as in RFC 8439, section 2.3. */
#include "bench/clients/cipher/chacha.h"

#include <string.h>

static uint32_t rotate(uint32_t word, int bits)
{
    return word << bits | word >> (32 - bits);
}

static void quarter(uint32_t *x, int a, int b, int c, int d)
{
    x[a] += x[b], x[d] = rotate(x[d] ^ x[a], 16);
    x[c] += x[d], x[b] = rotate(x[b] ^ x[c], 12);
    x[a] += x[b], x[d] = rotate(x[d] ^ x[a], 8);
    x[c] += x[d], x[b] = rotate(x[b] ^ x[c], 7);
}

static void key_stream(int rounds, const uint32_t state[CHACHA_WORDS], uint32_t x[CHACHA_WORDS])
{
    memcpy(x, state, CHACHA_BLOCK);
    for (int round = 0; round < rounds; round += 2) {
        quarter(x, 0, 4, 8, 12);
        quarter(x, 1, 5, 9, 13);
        quarter(x, 2, 6, 10, 14);
        quarter(x, 3, 7, 11, 15);
        quarter(x, 0, 5, 10, 15);
        quarter(x, 1, 6, 11, 12);
        quarter(x, 2, 7, 8, 13);
        quarter(x, 3, 4, 9, 14);
    }
    for (int i = 0; i < CHACHA_WORDS; i++)
        x[i] += state[i];
}

void chacha_plain_encrypt(int rounds, const uint32_t state[CHACHA_WORDS], const uint8_t *message,
                          size_t bytes, uint8_t *out)
{
    uint32_t block[CHACHA_WORDS], x[CHACHA_WORDS];
    uint8_t stream[CHACHA_BLOCK];
    memcpy(block, state, sizeof block);
    for (size_t at = 0; at < bytes; at += CHACHA_BLOCK, block[CHACHA_COUNTER]++) {
        size_t length = bytes - at < CHACHA_BLOCK ? bytes - at : CHACHA_BLOCK;
        key_stream(rounds, block, x);
        memcpy(stream, x, sizeof stream);
        for (size_t i = 0; i < length; i++)
            out[at + i] = message[at + i] ^ stream[i];
    }
}
