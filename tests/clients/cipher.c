/* The cipher against the vectors of RFC 8439, and every engine against plain C. */
#include "bench/clients/cipher/chacha.h"
#include <unity.h>

#include <stdlib.h>
#include <string.h>

enum { MOST = 40000 };

static const char *const engines[] = {"emulate",           "batch",         "specialize-1",   "specialize-4",
                                      "specialize-8",      "specialize-16", "specialize-8x2", "specialize",
                                      "specialize-thesis", "external"};
enum { ENGINES = sizeof engines / sizeof engines[0] };

static uint8_t message[MOST], expected[MOST], got[MOST];
static uint32_t state[CHACHA_WORDS];

void setUp(void)
{
    for (size_t i = 0; i < MOST; i++)
        message[i] = (uint8_t)(i * 2654435761u >> 13);
}

void tearDown(void)
{
}

static struct kernel *create(const struct chacha_choice *choice, const char *engine)
{
    struct error error = {{0}};
    struct kernel *kernel = kernel_create(&chacha_kernel, choice, CHACHA_BLOCK, engine, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(kernel, error.text);
    return kernel;
}

static void set_state(uint32_t counter, const uint8_t nonce[12])
{
    uint8_t key[32];
    for (int i = 0; i < 32; i++)
        key[i] = (uint8_t)i;
    chacha_state(state, key, counter, nonce);
}

/* RFC 8439, section 2.3.2: the key stream is the encryption of zeros. */
static void test_the_block_function_has_the_vector_of_the_standard(void)
{
    static const uint8_t nonce[12] = {0, 0, 0, 9, 0, 0, 0, 0x4a, 0, 0, 0, 0};
    static const uint8_t vector[64] = {
        0x10, 0xf1, 0xe7, 0xe4, 0xd1, 0x3b, 0x59, 0x15, 0x50, 0x0f, 0xdd, 0x1f, 0xa3, 0x20, 0x71, 0xc4,
        0xc7, 0xd1, 0xf4, 0xc7, 0x33, 0xc0, 0x68, 0x03, 0x04, 0x22, 0xaa, 0x9a, 0xc3, 0xd4, 0x6c, 0x4e,
        0xd2, 0x82, 0x64, 0x46, 0x07, 0x9f, 0xaa, 0x09, 0x14, 0xc2, 0xd7, 0x05, 0xd9, 0x8b, 0x02, 0xa2,
        0xb5, 0x12, 0x9c, 0xd1, 0xde, 0x16, 0x4e, 0xb9, 0xcb, 0xd0, 0x83, 0xe8, 0xa2, 0x50, 0x3c, 0x4e};
    struct chacha_choice choice = {.rounds = 20};
    set_state(1, nonce);
    memcpy(choice.state, state, sizeof state);
    memset(message, 0, 64);
    chacha_plain_encrypt(20, state, message, 64, got);
    TEST_ASSERT_EQUAL_MEMORY(vector, got, 64);
    for (int i = 0; i < ENGINES; i++) {
        if (kernel_unavailable(engines[i]))
            continue;
        struct kernel *kernel = create(&choice, engines[i]);
        memset(got, 0, 64);
        chacha_kernel_encrypt(kernel, state, message, 64, got);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(vector, got, 64, engines[i]);
        kernel_free(kernel);
    }
}

/* RFC 8439, section 2.4.2. */
static void test_the_sunscreen_text_has_the_vector_of_the_standard(void)
{
    static const uint8_t nonce[12] = {0, 0, 0, 0, 0, 0, 0, 0x4a, 0, 0, 0, 0};
    static const char text[] =
        "Ladies and Gentlemen of the class of '99: If I could offer you only one tip for "
        "the future, sunscreen would be it.";
    static const uint8_t first[] = {0x6e, 0x2e, 0x35, 0x9a, 0x25, 0x68, 0xf9, 0x80,
                                    0x41, 0xba, 0x07, 0x28, 0xdd, 0x0d, 0x69, 0x81};
    static const uint8_t last[] = {0x5a, 0xf9, 0x0b, 0xbf, 0x74, 0xa3, 0x5b, 0xe6, 0xb4,
                                   0x0b, 0x8e, 0xed, 0xf2, 0x78, 0x5e, 0x42, 0x87, 0x4d};
    struct chacha_choice choice = {.rounds = 20};
    size_t bytes = sizeof text - 1;
    set_state(1, nonce);
    memcpy(choice.state, state, sizeof state);
    struct kernel *kernel = create(&choice, kernel_unavailable("specialize") ? "emulate" : "specialize");
    chacha_kernel_encrypt(kernel, state, (const uint8_t *)text, bytes, got);
    TEST_ASSERT_EQUAL_MEMORY(first, got, sizeof first);
    TEST_ASSERT_EQUAL_MEMORY(last, got + bytes - sizeof last, sizeof last);
    kernel_free(kernel);
}

/* Lengths around the ends of blocks, runs and groups of lanes; the counter passes 2^32. */
static void compare_lengths(const char *engine, const struct chacha_choice *choice)
{
    static const size_t lengths[] = {0, 1, 63, 64, 65, 511, 1023, 1024, 1025, 16383, 16384, 17500, MOST};
    struct kernel *kernel = create(choice, engine);
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        memset(expected, 0xee, MOST);
        memset(got, 0xee, MOST);
        chacha_plain_encrypt(choice->rounds, state, message, lengths[i], expected);
        chacha_kernel_encrypt(kernel, state, message, lengths[i], got);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(expected, got, MOST, engine);
    }
    memcpy(got, message, MOST);
    chacha_kernel_encrypt(kernel, state, got, MOST, got);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(expected, got, MOST, "in place");
    kernel_free(kernel);
}

static void test_every_engine_encrypts_every_length_as_plain_c_does(void)
{
    static const uint8_t nonce[12] = {7, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 250};
    set_state(0xffffff00, nonce);
    for (int rounds = 8; rounds <= 20; rounds += 4)
        for (int fixed = 0; fixed < 2; fixed++)
            for (int i = 0; i < ENGINES; i++) {
                struct chacha_choice choice = {.rounds = rounds, .fixed = fixed};
                memcpy(choice.state, state, sizeof state);
                if (rounds == 20 || !strcmp(engines[i], "specialize"))
                    if (!kernel_unavailable(engines[i]))
                        compare_lengths(engines[i], &choice);
            }
}

/* The first round's columns without the counter are computed while the kernel is built: 3 quarter rounds of
 * 4 additions, 4 exclusive ors and 4 rotations each become 12 literals. */
static void test_a_fixed_key_leaves_fewer_operations(void)
{
    static const uint8_t nonce[12] = {1};
    struct chacha_choice choice = {.rounds = 20};
    if (kernel_unavailable("specialize-8"))
        TEST_IGNORE_MESSAGE("needs AVX2");
    set_state(0, nonce);
    memcpy(choice.state, state, sizeof state);
    struct kernel *any = create(&choice, "specialize-8");
    choice.fixed = true;
    struct kernel *fixed = create(&choice, "specialize-8");
    TEST_ASSERT_EQUAL(kernel_size(any).recorded, kernel_size(fixed).recorded);
    TEST_ASSERT_LESS_OR_EQUAL(kernel_size(any).instructions - 3 * 12 + 12, kernel_size(fixed).instructions);
    kernel_free(any);
    kernel_free(fixed);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_block_function_has_the_vector_of_the_standard);
    RUN_TEST(test_the_sunscreen_text_has_the_vector_of_the_standard);
    RUN_TEST(test_every_engine_encrypts_every_length_as_plain_c_does);
    RUN_TEST(test_a_fixed_key_leaves_fewer_operations);
    return UNITY_END();
}
