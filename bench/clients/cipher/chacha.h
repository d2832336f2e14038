/* ChaCha20 as a kernel (RFC 8439), and its plain C.
 *
 * An element is a block of 64 bytes. The choice decides the number of rounds and, if `fixed`, the key and the
 * nonce: their words are then literals of the code. Three of the four columns of the first round depend only
 * on these and are computed while the kernel is built. */
#ifndef CLIENTS_CIPHER_CHACHA_H
#define CLIENTS_CIPHER_CHACHA_H

#include "bench/clients/kernel.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CHACHA_WORDS = 16, CHACHA_BLOCK = 4 * CHACHA_WORDS, CHACHA_COUNTER = 12 };

struct chacha_choice {
    int rounds; /* even: 20, or 8 and 12 for the shorter ciphers of the family */
    bool fixed;
    uint32_t state[CHACHA_WORDS]; /* if fixed: as in struct chacha_job */
};

/* The initial state: four constants, eight words of key, the number of the first block, three of nonce. */
struct chacha_job {
    uint32_t state[CHACHA_WORDS];
    const uint8_t *message;
};

extern const struct kernel_text chacha_kernel;

/* The two readings of the text. */
void chacha_record(struct ir *ir, const void *choice);
void chacha_execute(const void *choice, const struct kernel_arguments *call, unsigned stride);

/* Sets the state from a key, the number of the first block and a nonce. */
void chacha_state(uint32_t state[CHACHA_WORDS], const uint8_t key[32], uint32_t counter,
                  const uint8_t nonce[12]);

/* Encrypts with a kernel. Every length is valid. `out` may be `message`. */
void chacha_kernel_encrypt(const struct kernel *kernel, const uint32_t state[CHACHA_WORDS],
                           const uint8_t *message, size_t bytes, uint8_t *out);

/* Encrypts with plain C. */
void chacha_plain_encrypt(int rounds, const uint32_t state[CHACHA_WORDS], const uint8_t *message,
                          size_t bytes, uint8_t *out);

#endif
