#include "base/digest.h"

#include <string.h>

enum { ROUNDS = 12, MESSAGE = 16 };

static const uint64_t initial[DIGEST_WORDS] = {
    0x6a09e667f3bcc908, 0xbb67ae8584caa73b, 0x3c6ef372fe94f82b, 0xa54ff53a5f1d36f1,
    0x510e527fade682d1, 0x9b05688c2b3e6c1f, 0x1f83d9abfb41bd6b, 0x5be0cd19137e2179,
};

/* The order of the message's words in each round; the last two rounds repeat the first two. */
static const uint8_t order[ROUNDS][MESSAGE] = {
    {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
    {14, 10, 4, 8, 9, 15, 13, 6, 1, 12, 0, 2, 11, 7, 5, 3},
    {11, 8, 12, 0, 5, 2, 15, 13, 10, 14, 3, 6, 7, 1, 9, 4},
    {7, 9, 3, 1, 13, 12, 11, 14, 2, 6, 5, 10, 4, 0, 15, 8},
    {9, 0, 5, 7, 2, 4, 10, 15, 14, 1, 11, 12, 6, 8, 3, 13},
    {2, 12, 6, 10, 0, 11, 8, 3, 4, 13, 7, 5, 15, 14, 1, 9},
    {12, 5, 1, 15, 14, 13, 4, 10, 0, 7, 6, 3, 9, 2, 8, 11},
    {13, 11, 7, 14, 12, 1, 3, 9, 5, 0, 15, 4, 8, 6, 2, 10},
    {6, 15, 14, 9, 11, 3, 0, 8, 12, 2, 13, 7, 1, 4, 10, 5},
    {10, 2, 8, 4, 7, 6, 1, 5, 15, 11, 9, 14, 3, 12, 13, 0},
    {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
    {14, 10, 4, 8, 9, 15, 13, 6, 1, 12, 0, 2, 11, 7, 5, 3},
};

static inline uint64_t rotate_right(uint64_t value, int bits)
{
    return value >> bits | value << (64 - bits);
}

static inline void mix(uint64_t *a, uint64_t *b, uint64_t *c, uint64_t *d, uint64_t x, uint64_t y)
{
    *a += *b + x;
    *d = rotate_right(*d ^ *a, 32);
    *c += *d;
    *b = rotate_right(*b ^ *c, 24);
    *a += *b + y;
    *d = rotate_right(*d ^ *a, 16);
    *c += *d;
    *b = rotate_right(*b ^ *c, 63);
}

/* Unrolled, so that the order of words is constant and `v` is in registers. */
__attribute__((always_inline)) static inline void mix_all(uint64_t v[16], const uint64_t m[MESSAGE],
                                                          const uint8_t s[MESSAGE])
{
    mix(v + 0, v + 4, v + 8, v + 12, m[s[0]], m[s[1]]);
    mix(v + 1, v + 5, v + 9, v + 13, m[s[2]], m[s[3]]);
    mix(v + 2, v + 6, v + 10, v + 14, m[s[4]], m[s[5]]);
    mix(v + 3, v + 7, v + 11, v + 15, m[s[6]], m[s[7]]);
    mix(v + 0, v + 5, v + 10, v + 15, m[s[8]], m[s[9]]);
    mix(v + 1, v + 6, v + 11, v + 12, m[s[10]], m[s[11]]);
    mix(v + 2, v + 7, v + 8, v + 13, m[s[12]], m[s[13]]);
    mix(v + 3, v + 4, v + 9, v + 14, m[s[14]], m[s[15]]);
}

/* Words are little-endian, as in memory. `last` is all ones for the last block, else 0. */
static void compress(struct digest_state *state, const uint8_t block[DIGEST_BLOCK], uint64_t last)
{
    uint64_t message[MESSAGE], v[2 * DIGEST_WORDS];
    memcpy(message, block, DIGEST_BLOCK);
    memcpy(v, state->word, sizeof state->word);
    memcpy(v + DIGEST_WORDS, initial, sizeof initial);
    v[12] ^= state->bytes;
    v[14] ^= last;
#pragma GCC unroll 12
    for (int round = 0; round < ROUNDS; round++)
        mix_all(v, message, order[round]);
    for (int i = 0; i < DIGEST_WORDS; i++)
        state->word[i] ^= v[i] ^ v[i + DIGEST_WORDS];
}

/* The parameters: the length of the result, no key, one leaf. */
void digest_begin(struct digest_state *state)
{
    *state = (struct digest_state){.bytes = 0};
    memcpy(state->word, initial, sizeof initial);
    state->word[0] ^= 0x01010000 ^ DIGEST_BYTES;
}

/* The last block is special, so a full block waits until more bytes arrive. */
void digest_add(struct digest_state *state, const void *data, size_t bytes)
{
    const uint8_t *at = data;
    while (bytes) {
        if (state->waiting == DIGEST_BLOCK) {
            state->bytes += DIGEST_BLOCK;
            compress(state, state->block, 0);
            state->waiting = 0;
        }
        for (; !state->waiting && bytes > DIGEST_BLOCK; at += DIGEST_BLOCK, bytes -= DIGEST_BLOCK) {
            state->bytes += DIGEST_BLOCK;
            compress(state, at, 0);
        }
        size_t room = DIGEST_BLOCK - state->waiting, some = bytes < room ? bytes : room;
        memcpy(state->block + state->waiting, at, some);
        state->waiting += some;
        at += some;
        bytes -= some;
    }
}

struct digest digest_end(struct digest_state *state)
{
    struct digest digest;
    state->bytes += state->waiting;
    memset(state->block + state->waiting, 0, DIGEST_BLOCK - state->waiting);
    compress(state, state->block, UINT64_MAX);
    memcpy(digest.byte, state->word, DIGEST_BYTES);
    return digest;
}

struct digest digest_of(const void *data, size_t bytes)
{
    struct digest_state state;
    digest_begin(&state);
    digest_add(&state, data, bytes);
    return digest_end(&state);
}
