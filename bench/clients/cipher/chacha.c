/* The cipher around its kernel: whole rounds of blocks directly, the rest through a buffer. */
#include "bench/clients/cipher/chacha.h"

#include <string.h>

const struct kernel_text chacha_kernel = {"chacha", chacha_record, chacha_execute};

/* The blocks of one run. */
enum { RUN_BLOCKS = 256 };

#define FOUR(n)    n, n + 1, n + 2, n + 3
#define SIXTEEN(n) FOUR(n), FOUR(n + 4), FOUR(n + 8), FOUR(n + 12)
#define RUN(n)     SIXTEEN(n), SIXTEEN(n + 16), SIXTEEN(n + 32), SIXTEEN(n + 48)

static const int32_t block_number[RUN_BLOCKS] = {RUN(0), RUN(64), RUN(128), RUN(192)};

static uint32_t word_at(const uint8_t *bytes)
{
    uint32_t word;
    memcpy(&word, bytes, sizeof word);
    return word;
}

void chacha_state(uint32_t state[CHACHA_WORDS], const uint8_t key[32], uint32_t counter,
                  const uint8_t nonce[12])
{
    static const uint8_t constant[] = "expand 32-byte k";
    for (int i = 0; i < 4; i++)
        state[i] = word_at(constant + 4 * i);
    for (int i = 0; i < 8; i++)
        state[4 + i] = word_at(key + 4 * i);
    state[CHACHA_COUNTER] = counter;
    for (int i = 0; i < 3; i++)
        state[13 + i] = word_at(nonce + 4 * i);
}

/* Encrypts the last bytes, fewer than KERNEL_ELEMENTS blocks. */
static void encrypt_rest(const struct kernel *kernel, struct chacha_job *job, const uint8_t *message,
                         size_t bytes, uint8_t *out)
{
    uint8_t buffer[KERNEL_ELEMENTS * CHACHA_BLOCK] = {0};
    memcpy(buffer, message, bytes);
    job->message = buffer;
    kernel_run(kernel, job, block_number, buffer, KERNEL_ELEMENTS);
    memcpy(out, buffer, bytes);
}

void chacha_kernel_encrypt(const struct kernel *kernel, const uint32_t state[CHACHA_WORDS],
                           const uint8_t *message, size_t bytes, uint8_t *out)
{
    struct chacha_job job;
    memcpy(job.state, state, sizeof job.state);
    const size_t whole = KERNEL_ELEMENTS * CHACHA_BLOCK;
    while (bytes >= whole) {
        size_t run = bytes < RUN_BLOCKS * CHACHA_BLOCK ? bytes / whole * whole : RUN_BLOCKS * CHACHA_BLOCK;
        job.message = message;
        kernel_run(kernel, &job, block_number, out, (uint32_t)(run / CHACHA_BLOCK));
        job.state[CHACHA_COUNTER] += (uint32_t)(run / CHACHA_BLOCK);
        message += run, out += run, bytes -= run;
    }
    if (bytes)
        encrypt_rest(kernel, &job, message, bytes, out);
}
