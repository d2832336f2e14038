/* Digests (base/digest.h), against the values of other implementations. */
#include "base/digest.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

static uint8_t contents[1000];

void setUp(void)
{
    for (size_t i = 0; i < sizeof contents; i++)
        contents[i] = (uint8_t)(7 * i);
}

void tearDown(void)
{
}

static void expect_digest(const char *expected, struct digest digest)
{
    char text[2 * DIGEST_BYTES + 1];
    for (int i = 0; i < DIGEST_BYTES; i++)
        snprintf(text + 2 * i, 3, "%02x", digest.byte[i]);
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

/* Python: hashlib.blake2b(bytes(7 * i & 255 for i in range(N)), digest_size=32), or b2sum -l 256. */
static void digests_are_those_of_blake2b(void)
{
    expect_digest("0e5751c026e543b2e8ab2eb06099daa1d1e5df47778f7787faab45cdf12fe3a8", digest_of("", 0));
    expect_digest("03170a2e7597b7b7e3d84c05391d139a62b157e78786d8c082f29dcf4c111314", digest_of(contents, 1));
    expect_digest("4ff62e7c4c43fe101a078479c48836be4907d9d498dcc577ca89d694b2c11f9b",
                  digest_of(contents, 127));
    expect_digest("14696d2a98d9f8a280da8b132b1045b345e1033759c6b02fcc4ee885c8ae7c37",
                  digest_of(contents, 128));
    expect_digest("3934215260b1039be9d9d2b073b059bcd50120c327a22af93eb4d98cf821c14c",
                  digest_of(contents, 129));
    expect_digest("3d0cb2693dfbac42af5a6cc960953fea8714aa39c4bcd054ef61d6b5e98ade4a",
                  digest_of(contents, 256));
    expect_digest("63cb41934eb22ceb359755501ea299abcd784306baf8845ad6b97ff0828b7cfe",
                  digest_of(contents, 257));
}

static void pieces_have_the_digest_of_the_whole(void)
{
    struct digest whole = digest_of(contents, sizeof contents);
    for (size_t piece = 1; piece < 300; piece++) {
        struct digest_state state;
        digest_begin(&state);
        for (size_t at = 0; at < sizeof contents; at += piece)
            digest_add(&state, contents + at, sizeof contents - at < piece ? sizeof contents - at : piece);
        struct digest digest = digest_end(&state);
        TEST_ASSERT_EQUAL_MEMORY(&whole, &digest, sizeof whole);
    }
}

static void every_bit_counts(void)
{
    struct digest whole = digest_of(contents, sizeof contents);
    for (size_t i = 0; i < sizeof contents; i += 37) {
        contents[i] ^= (uint8_t)(1 << i % 8);
        struct digest digest = digest_of(contents, sizeof contents);
        TEST_ASSERT_TRUE(memcmp(&whole, &digest, sizeof whole) != 0);
        contents[i] ^= (uint8_t)(1 << i % 8);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(digests_are_those_of_blake2b);
    RUN_TEST(pieces_have_the_digest_of_the_whole);
    RUN_TEST(every_bit_counts);
    return UNITY_END();
}
