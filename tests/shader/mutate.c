/* Randomly damaged shaders, as text and as tokens. Each is refused with one line at a position, or is a
 * shader. A shader is converted to tokens and text and back, and the validator accepts or refuses it. Builds
 * with sanitizers check the memory accesses. The seed is fixed unless TRIPTYCH_SEED is set. */
#include "shader/shader.h"
#include "tests/support/system/seed.h"
#include "tests/support/shader/shaders.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

enum { INSTRUCTIONS = 25, MUTATIONS = 400, CAPACITY = 1 << 16 };

static struct error error;
static uint64_t seed;

void setUp(void)
{
    error_clear(&error);
    seed = test_seed();
}

void tearDown(void)
{
}

static struct shader *random_shader(const struct shader_model *model)
{
    struct shader *shader = shader_blank(model);
    for (int i = 0; i < INSTRUCTIONS;) {
        enum shader_opcode opcode = shader_random(&seed, SHADER_COUNT);
        if (shader_slots(&shader_operations[opcode], model) < 0)
            continue;
        shader_add_random(shader, opcode, &seed);
        i++;
    }
    return shader;
}

static void expect_one_line(const char *path)
{
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(path, error.text, strlen(path), error.text);
    TEST_ASSERT_NULL_MESSAGE(strchr(error.text, '\n'), error.text);
}

/* The validator accepts a shader or refuses it with a position. */
static void expect_opinion(const struct shader *shader)
{
    error_clear(&error);
    if (shader_validate(shader, NULL, &error))
        expect_one_line(shader->path);
    else
        TEST_ASSERT_EQUAL_STRING("", error.text);
}

/* A shader that a reader accepted can be printed, encoded and validated. */
static void expect_sound(const struct shader *shader)
{
    struct shader *again;
    uint32_t *tokens, *tokens_again;
    size_t count, count_again, bytes;
    char *text;
    expect_opinion(shader);
    TEST_ASSERT_EQUAL_INT(0, shader_encode(shader, &tokens, &count, &error));
    TEST_ASSERT_EQUAL_INT(0, shader_print(shader, &text, &bytes, &error));
    int bad = shader_assemble("again", text, bytes, &again, &error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, bad, error.text);
    TEST_ASSERT_EQUAL_INT(0, shader_encode(again, &tokens_again, &count_again, &error));
    TEST_ASSERT_EQUAL_UINT64(count, count_again);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(tokens, tokens_again, count);
    shader_free(again);
    free(tokens);
    free(tokens_again);
    free(text);
}

static const char *const pieces[] = {
    "r0",   "c[a0.x + 5]", "aL",          "[",     "]",          ".",     ",",     "-",
    "1-",   "!",           "(p0)",        "(",     "+",          "\n",    " ",     "_sat",
    "_x2",  "_bx2",        "_abs",        ".xyz",  ".wzyx",      "if b0", "endif", "mov",
    "99",   "8191",        "2147483648",  "1e38",  "0x7fc00000", "/*",    "*/",    "dcl_2d s0",
    "\xff", "vs_3_0\n",    "loop aL, i0", "texld", "\"",         "o[aL",  "oPos",  "true",
};

static size_t mutate_text(char *text, size_t bytes)
{
    size_t at = shader_random(&seed, (uint32_t)bytes + 1), count = 1 + shader_random(&seed, 6);
    const char *piece = pieces[shader_random(&seed, sizeof pieces / sizeof *pieces)];
    switch (shader_random(&seed, 4)) {
    case 0:
        memmove(text + at + strlen(piece), text + at, bytes - at);
        memcpy(text + at, piece, strlen(piece));
        return bytes + strlen(piece);
    case 1:
        count = count > bytes - at ? bytes - at : count;
        memmove(text + at, text + at + count, bytes - at - count);
        return bytes - count;
    case 2:
        if (at < bytes)
            text[at] ^= (char)(1 << shader_random(&seed, 8));
        return bytes;
    default: return shader_random(&seed, 4) ? bytes : at;
    }
}

static void damaged_text_survives(void)
{
    char *changed = malloc(CAPACITY);
    unsigned good = 0, bad = 0;
    for (unsigned m = 0; m < MODEL_COUNT; m++) {
        struct shader *shader = random_shader(&shader_models[m]);
        char *text;
        size_t original;
        TEST_ASSERT_EQUAL_INT(0, shader_print(shader, &text, &original, &error));
        shader_free(shader);
        for (int i = 0; i < MUTATIONS; i++) {
            size_t bytes = original;
            memcpy(changed, text, bytes);
            for (uint32_t changes = 1 + shader_random(&seed, 2); changes; changes--)
                bytes = mutate_text(changed, bytes);
            error_clear(&error);
            if (shader_assemble("text", changed, bytes, &shader, &error)) {
                expect_one_line("text:");
                bad++;
                continue;
            }
            good++;
            expect_sound(shader);
            shader_free(shader);
        }
        free(text);
    }
    free(changed);
    TEST_ASSERT_TRUE(good > MUTATIONS && bad > MUTATIONS);
}

/* Changes bits or whole tokens, removes or repeats a token, or removes the last ones. */
static size_t mutate_tokens(uint32_t *tokens, size_t count)
{
    size_t at = shader_random(&seed, (uint32_t)count);
    switch (shader_random(&seed, 6)) {
    case 0: tokens[at] = shader_random(&seed, 0xffffffff); return count;
    case 1: tokens[at] = tokens[shader_random(&seed, (uint32_t)count)]; return count;
    case 2: memmove(tokens + at, tokens + at + 1, (count - at - 1) * 4); return count - 1;
    case 3: memmove(tokens + at + 1, tokens + at, (count - at) * 4); return count + 1;
    case 4: return shader_random(&seed, 3) ? count : at + 1;
    default: tokens[at] ^= 1u << shader_random(&seed, 32); return count;
    }
}

static void damaged_tokens_survive(void)
{
    unsigned good = 0, bad = 0;
    for (unsigned m = 0; m < MODEL_COUNT; m++) {
        struct shader *shader = random_shader(&shader_models[m]);
        uint32_t *tokens;
        size_t original;
        TEST_ASSERT_EQUAL_INT(0, shader_encode(shader, &tokens, &original, &error));
        shader_free(shader);
        for (int i = 0; i < MUTATIONS; i++) {
            size_t count = original;
            uint32_t *changed = malloc((count + 4) * 4);
            memcpy(changed, tokens, count * 4);
            for (uint32_t changes = 1 + shader_random(&seed, 2); changes; changes--)
                count = mutate_tokens(changed, count);
            /* Exactly the size of the tokens, so that the sanitizer finds reads after their end. */
            changed = realloc(changed, count * 4);
            error_clear(&error);
            if (shader_read("tokens", changed, count * 4, &shader, &error)) {
                expect_one_line("tokens: ");
                bad++;
            } else {
                good++;
                expect_sound(shader);
                shader_free(shader);
            }
            free(changed);
        }
        free(tokens);
    }
    TEST_ASSERT_TRUE(good > MUTATIONS && bad > MUTATIONS);
}

/* In valid shaders an operand or two are changed, which is enough to break most rules. */
static void damaged_valid_shaders_survive(void)
{
    static const char *const texts[] = {
        "vs_2_x\ndcl_position v0\nmova a0, v0\nmov r0, c1[a0.x]\nsetp_gt p0, r0, v0\n(p0) add r0, r0, c0\nif "
        "p0.x\nelse\n"
        "endif\nloop aL, i0\nmov r1, c[aL]\nbreak_gt r0.x, r1.x\nendloop\ncall l0\nmov oPos, r0\nret\nlabel "
        "l0\nret\n",
        "vs_3_0\ndcl_position v0\ndcl_position o0\ndcl_2d s0\ntexldl r0, v0, s0\nloop aL, i0\nmov o[aL], "
        "v[aL]\nendloop\n"
        "m4x4 r1, r0, c0\nmov o0, r1\n",
        "ps_1_3\ntex t0\ntexm3x2pad t1, t0\ntexm3x2depth t2, t0\nmul_x2 r0.xyz, t0, v0\n+mov r0.w, c0\n",
        "ps_1_4\ntexld r0, t0\ntexcrd r1.xyz, t1\nmov r0, r0\nphase\ntexld r2, r0_dz\ntexdepth r5\nmov r0, "
        "r2\n",
        "ps_3_0\ndcl_texcoord v0\ndcl vFace\ndcl_cube s0\nrep i0\ntexld r0, v0, s0\nif_gt r0.x, "
        "c0.x\nbreak\nendif\nendrep\n"
        "dsx r1, r0\ncmp oC0, vFace, r0, r1\n",
    };
    unsigned valid = 0, refused = 0;
    for (int i = 0; i < 20000; i++) {
        const char *text = texts[i % 5];
        struct shader *shader;
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_assemble("t", text, strlen(text), &shader, &error),
                                      error.text);
        for (uint32_t changes = 1 + shader_random(&seed, 2); changes; changes--)
            shader_damage(shader, &seed);
        error_clear(&error);
        shader_validate(shader, NULL, &error) ? refused++ : valid++;
        error_clear(&error);
        shader_free(shader);
    }
    TEST_ASSERT_TRUE(valid > 500 && refused > 500);
}

static void noise_survives(void)
{
    for (int i = 0; i < 4000; i++) {
        uint32_t noise[40];
        struct shader *shader;
        for (size_t j = 0; j < sizeof noise / sizeof *noise; j++)
            noise[j] = shader_random(&seed, 0xffffffff);
        if (i % 2)
            noise[0] = shader_models[i / 2 % MODEL_COUNT].version |
                       (shader_models[i / 2 % MODEL_COUNT].stage ? 0xffff0000 : 0xfffe0000);
        error_clear(&error);
        TEST_ASSERT_EQUAL_INT(-1, shader_read("noise", noise, sizeof noise, &shader, &error));
        error_clear(&error);
        TEST_ASSERT_EQUAL_INT(-1, shader_assemble("noise", (char *)noise, sizeof noise, &shader, &error));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(damaged_text_survives);
    RUN_TEST(damaged_tokens_survive);
    RUN_TEST(damaged_valid_shaders_survive);
    RUN_TEST(noise_survives);
    return UNITY_END();
}
