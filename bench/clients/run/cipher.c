/* ChaCha20 with OpenSSL's libcrypto. */
#include "bench/clients/cipher/chacha.h"
#include "bench/clients/run/work.h"

#include <openssl/evp.h>
#include <stdlib.h>
#include <string.h>

enum { MESSAGE = 1 << 20 };

struct cipher_state {
    uint8_t key[32], nonce[12];
    uint32_t words[CHACHA_WORDS];
    uint8_t *message;
    EVP_CIPHER_CTX *context;
};

/* OpenSSL's initial vector is the number of the first block and the nonce. */
static void encrypt_library(const struct cipher_state *state, uint8_t *out, size_t bytes)
{
    uint8_t vector[16];
    int count;
    memcpy(vector, state->words + CHACHA_COUNTER, sizeof vector);
    if (!EVP_EncryptInit_ex(state->context, EVP_chacha20(), NULL, state->key, vector) ||
        !EVP_EncryptUpdate(state->context, out, &count, state->message, (int)bytes))
        work_fail("libcrypto refuses ChaCha20");
}

static void run(struct work *work, enum way way, const struct kernel *kernel)
{
    const struct cipher_state *state = work->state;
    if (way == WAY_PLAIN)
        chacha_plain_encrypt(20, state->words, state->message, work->bytes, work->out);
    else if (way == WAY_LIBRARY)
        encrypt_library(state, work->out, work->bytes);
    else
        chacha_kernel_encrypt(kernel, state->words, state->message, work->bytes, work->out);
}

static struct cipher_state *make_state(size_t bytes)
{
    struct cipher_state *state = work_memory(sizeof *state);
    for (int i = 0; i < 32; i++)
        state->key[i] = (uint8_t)(7 * i + 3);
    for (int i = 0; i < 12; i++)
        state->nonce[i] = (uint8_t)(5 * i + 1);
    chacha_state(state->words, state->key, 1, state->nonce);
    state->message = work_memory(bytes);
    state->context = EVP_CIPHER_CTX_new();
    if (!state->context)
        work_fail("libcrypto has no memory");
    for (size_t i = 0; i < bytes; i++)
        state->message[i] = (uint8_t)(i * 2654435761u >> 11);
    return state;
}

size_t work_cipher(struct work *work)
{
    struct cipher_state *state = make_state(MESSAGE);
    struct chacha_choice *choice = work_memory(2 * sizeof *choice);
    for (int fixed = 0; fixed < 2; fixed++) {
        choice[fixed] = (struct chacha_choice){.rounds = 20, .fixed = fixed};
        memcpy(choice[fixed].state, state->words, sizeof state->words);
        work[fixed] = (struct work){.name = fixed ? "cipher, fixed key" : "cipher",
                                    .library = "OpenSSL",
                                    .about = "ChaCha20, 20 rounds",
                                    .bytes = MESSAGE,
                                    .out_bytes = MESSAGE,
                                    .stride = CHACHA_BLOCK,
                                    .text = &chacha_kernel,
                                    .choice = &choice[fixed],
                                    .out = work_memory(MESSAGE),
                                    .run = run,
                                    .state = state};
    }
    return 2;
}

unsigned work_cipher_differences(unsigned cases)
{
    enum { MOST = 5000 };
    static uint8_t expected[MOST], got[MOST];
    struct cipher_state *state = make_state(MOST);
    struct chacha_choice choice = {.rounds = 20};
    unsigned differences = 0;
    memcpy(choice.state, state->words, sizeof choice.state); /* the constants */
    struct kernel *kernel = work_kernel(&chacha_kernel, &choice, CHACHA_BLOCK);
    for (unsigned n = 0; n < cases; n++) {
        size_t bytes = (size_t)n * 37 % MOST;
        for (int i = 0; i < 32; i++)
            state->key[i] = (uint8_t)((n + 1) * 2654435761u >> i % 24);
        chacha_state(state->words, state->key, n * 77, state->nonce);
        encrypt_library(state, expected, bytes);
        chacha_kernel_encrypt(kernel, state->words, state->message, bytes, got);
        differences += memcmp(expected, got, bytes) != 0;
    }
    kernel_free(kernel);
    return differences;
}
