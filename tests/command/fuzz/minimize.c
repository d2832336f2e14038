/* Minimising: the result is the minimum, and it always fails. The tests use predicates with known results,
 * and the stream reader to decide if a text is a stream. */
#include "command/fuzz/reduce/minimize.h"
#include "base/random.h"
#include "command/stream/stream.h"

#include <unity.h>

#include <stdlib.h>
#include <string.h>

static struct text smallest;
static struct minimized made;
static struct error error;
static unsigned tests;

void setUp(void)
{
    error_clear(&error);
    tests = 0;
}

void tearDown(void)
{
    text_free(&smallest);
}

static int shrink(const char *text, minimize_test *still_fails, void *user)
{
    return minimize(text, strlen(text), still_fails, user, 0, &smallest, &made, &error);
}

/* --- Predicates ----------------------------------------------------------------------------------------- */

/* The case fails if the text contains all of the strings. */
static bool has_all(void *user, const char *text, size_t bytes)
{
    tests++;
    TEST_ASSERT_EQUAL_UINT64(bytes, strlen(text));
    for (const char *const *part = user; *part; part++)
        if (!strstr(text, *part))
            return false;
    return true;
}

/* The case fails if the text contains all of the strings and is a stream. */
static bool is_stream_with_all(void *user, const char *text, size_t bytes)
{
    struct stream *stream;
    struct error reason = {{0}};
    if (!has_all(user, text, bytes) || stream_parse("case.tri", text, bytes, &stream, &reason))
        return false;
    stream_free(stream);
    return true;
}

/* The case fails if the text is a stream that covers a pixel by calls of the type `user`. */
static bool draws(void *user, const char *text, size_t bytes)
{
    struct stream *stream;
    struct error reason = {{0}};
    bool found = false;
    if (stream_parse("case.tri", text, bytes, &stream, &reason))
        return false;
    for (uint32_t i = 0; i < stream->executed_count; i++) {
        const struct call *call = stream->calls + stream->executed[i];
        uint32_t count = call->type == CALL_DRAW_INDEXED ? call->draw_indexed.count : call->draw.count;
        found |= call->type == *(const enum call_type *)user && count > 0;
    }
    stream_free(stream);
    return found;
}

#define TEXTS(...) ((void *)(const char *const[]){__VA_ARGS__, NULL})

static const char plain[] = "triptych 1\n"
                            "# what this is\n"
                            "target 64 64\n"
                            "state alpha 1\n"
                            "state beta 2 # a comment\n"
                            "state gamma 3\n"
                            "clear color 1 0 0 1 depth 1\n"
                            "state delta 4\n"
                            "frame\n";

static void only_what_it_takes_is_left(void)
{
    TEST_ASSERT_EQUAL_INT(0, shrink(plain, has_all, TEXTS("beta", "delta")));
    TEST_ASSERT_EQUAL_STRING("triptych 1\nstate beta\nstate delta\n", smallest.data);
    TEST_ASSERT_TRUE(made.complete);
    TEST_ASSERT_EQUAL_UINT(tests, made.tries);
}

static void two_words_far_apart_in_one_statement(void)
{
    TEST_ASSERT_EQUAL_INT(0, shrink(plain, has_all, TEXTS("clear", "depth")));
    TEST_ASSERT_EQUAL_STRING("triptych 1\nclear depth\n", smallest.data);
}

static void what_does_not_fail_is_refused(void)
{
    TEST_ASSERT_EQUAL_INT(-1, shrink(plain, has_all, TEXTS("epsilon")));
    TEST_ASSERT_EQUAL_STRING("the stream to reduce does not fail", error.text);
    TEST_ASSERT_NULL(smallest.data);
    TEST_ASSERT_EQUAL_INT(-1, shrink("", has_all, TEXTS("epsilon")));
}

static void the_number_of_tries_is_bounded(void)
{
    void *texts = TEXTS("beta", "delta");
    for (unsigned tries = 1; tries < 20; tries++) {
        tests = 0;
        TEST_ASSERT_EQUAL_INT(
            0, minimize(plain, strlen(plain), has_all, texts, tries, &smallest, &made, &error));
        TEST_ASSERT_LESS_OR_EQUAL_UINT(tries, tests);
        TEST_ASSERT_FALSE(made.complete);
        TEST_ASSERT_TRUE(has_all(texts, smallest.data, smallest.length));
        text_free(&smallest);
    }
}

/* --- Any predicate -------------------------------------------------------------------------------------- */

/* The case fails depending on a hash of the lines that the text has. This predicate is not monotonic. */
struct odd {
    uint64_t seed;
    struct text last;
};

static bool is_odd(void *user, const char *text, size_t bytes)
{
    struct odd *odd = user;
    struct random random = {odd->seed};
    unsigned there = 0;
    for (const char *c = "abcdefgh"; *c; c++)
        there += (random_u64(&random) & 1) && memchr(text + 10, *c, bytes - 10);
    bool fails = there && (there & 1 || !random_chance(&random, 3)) && strstr(text, "triptych");
    if (fails) {
        text_cut(&odd->last, 0);
        text_add_bytes(&odd->last, text, bytes);
    }
    return fails;
}

static void the_result_always_fails_and_is_the_last_that_did(void)
{
    unsigned ran = 0;
    for (uint64_t seed = 1; seed < 60; seed++) {
        struct odd odd = {.seed = seed};
        if (!is_odd(&odd, plain, strlen(plain)))
            continue;
        TEST_ASSERT_EQUAL_INT(0, shrink(plain, is_odd, &odd));
        TEST_ASSERT_EQUAL_STRING(odd.last.data, smallest.data);
        TEST_ASSERT_TRUE(is_odd(&odd, smallest.data, smallest.length));
        text_free(&odd.last);
        text_free(&smallest);
        ran++;
    }
    TEST_ASSERT_GREATER_THAN_UINT(20, ran);
}

/* --- Streams -------------------------------------------------------------------------------------------- */

static const char whole[] =
    "triptych 1\n"
    "target 64 64 depth d24s8\n"
    "texture checker 4 4 { ffffffff ff404040 ffffffff ff404040 ff404040 ffffffff ff404040 ffffffff\n"
    "ffffffff ff404040 ffffffff ff404040 ff404040 ffffffff ff404040 ffffffff }\n"
    "texture other 2d R5G6B5 8 8 levels 2 mips checker 2 ff00ff00 ff0000ff\n"
    "vertices corner position:short4 diffuse:color texcoord:float2 {\n"
    "    -1 -1 0 1  0xffff0000   0 1\n"
    "     0  1 0 1  0xff00ff00   0 0\n"
    "     1 -1 0 1  0xff0000ff   1 1\n"
    "    -1 -1 0 1  0xffff0000   0 1\n"
    "     0  1 0 1  0xff00ff00   0 0\n"
    "     1 -1 0 1  0xff0000ff   1 1\n"
    "}\n"
    "indices order 16 { 0 1 2 2 1 3 5 4 3 }\n"
    "shader lit {\n"
    "    ps_2_0\n"
    "    def c0, 0.5, 0.25, 0.125, 3.75\n"
    "    dcl v0\n"
    "    mul r0, v0, c0\n"
    "    mad_sat r0.xyz, -r0, c0.wzyx, c0\n"
    "    add r0, r0, c0 ; the end\n"
    "    mov oC0, r0\n"
    "}\n"
    "shader loops {\n"
    "    ps_3_0\n"
    "    defi i0, 3, 0, 1, 0\n"
    "    def c0, 1, 2, 3, 4\n"
    "    mov r0, c0\n"
    "    rep i0\n"
    "    if b0\n"
    "    add r0, r0, c0\n"
    "    else\n"
    "    mul r0, r0, c0\n"
    "    endif\n"
    "    endrep\n"
    "    mov oC0, r0\n"
    "}\n"
    "sequence scene\n"
    "    clear color 0.1 0.1 0.2 1 depth 1 stencil 0\n"
    "    state lighting false\n"
    "    bind vertices corner\n"
    "    bind texture checker\n"
    "    pixelshader lit\n"
    "    draw triangles 0 2\n"
    "    bind indices order\n"
    "    draw-indexed triangles 0 0 3\n"
    "end\n"
    "transform world rotate 10 0 0 1\n"
    "play scene\n"
    "frame\n"
    "pixelshader loops\n"
    "bind texture other\n"
    "play scene\n";

static void shrinks(const char *expected, minimize_test *still_fails, void *user)
{
    int result = shrink(whole, still_fails, user);
    TEST_ASSERT_EQUAL_STRING("", error.text);
    TEST_ASSERT_EQUAL_INT(0, result);
    TEST_ASSERT_EQUAL_STRING(expected, smallest.data);
    TEST_ASSERT_TRUE(made.complete);
}

static void shrinks_to(const char *expected, void *texts)
{
    shrinks(expected, is_stream_with_all, texts);
}

static void a_draw_keeps_its_vertices_and_nothing_else(void)
{
    enum call_type type = CALL_DRAW;
    shrinks("triptych 1\ntarget 1 1\nvertices corner position:float4 {\n0 0 0 0\n0 0 0 0\n0 0 0 0\n}\n"
            "bind vertices corner\ndraw triangles 0 1\n",
            draws, &type);
}

static void an_indexed_draw_keeps_one_triangle(void)
{
    enum call_type type = CALL_DRAW_INDEXED;
    shrinks("triptych 1\ntarget 1 1\nvertices corner position:float4 {\n0 0 0 0\n}\n"
            "indices order 16 { 0 0 0 }\n"
            "bind vertices corner\nbind indices order\ndraw-indexed triangles 0 0 1\n",
            draws, &type);
}

static void a_shader_keeps_the_needed_instructions_with_plain_operands(void)
{
    shrinks_to("triptych 1\ntarget 1 1\nshader lit {\nps_2_0\ndcl v0\nmov r0, v0\nmad r0, r0, c0, c0\nmov "
               "oC0, r0\n}\n",
               TEXTS("mad"));
}

static void regions_of_shaders_go_with_both_their_ends(void)
{
    shrinks_to("triptych 1\ntarget 1 1\nshader loops {\nps_3_0\nmov r0, c0\nif b0\nendif\nmov oC0, r0\n}\n",
               TEXTS("if b0", "mov oC0"));
}

static void a_texture_becomes_small_and_plain(void)
{
    shrinks_to("triptych 1\ntarget 1 1\ntexture other 2d A8R8G8B8 1 1 empty\n", TEXTS("other 2d"));
    text_free(&smallest);
    shrinks_to("triptych 1\ntarget 1 1\ntexture checker 1 1 { 00000000\n}\n", TEXTS("texture checker", "}"));
}

static void the_same_text_gives_the_same_result(void)
{
    char first[2048];
    shrink(whole, is_stream_with_all, TEXTS("mul", "draw"));
    unsigned tries = made.tries;
    TEST_ASSERT_LESS_THAN_UINT64(sizeof first, smallest.length);
    strcpy(first, smallest.data);
    text_free(&smallest);
    shrink(whole, is_stream_with_all, TEXTS("mul", "draw"));
    TEST_ASSERT_EQUAL_STRING(first, smallest.data);
    TEST_ASSERT_EQUAL_UINT(tries, made.tries);
}

/* A minimum is its own minimum. */
static void making_it_smaller_again_changes_nothing(void)
{
    shrink(whole, is_stream_with_all, TEXTS("rep", "draw-indexed", "stencil"));
    struct text once = smallest;
    smallest = (struct text){0};
    shrink(once.data, is_stream_with_all, TEXTS("rep", "draw-indexed", "stencil"));
    TEST_ASSERT_EQUAL_STRING(once.data, smallest.data);
    TEST_ASSERT_EQUAL_UINT(1, made.rounds);
    text_free(&once);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(only_what_it_takes_is_left);
    RUN_TEST(two_words_far_apart_in_one_statement);
    RUN_TEST(what_does_not_fail_is_refused);
    RUN_TEST(the_number_of_tries_is_bounded);
    RUN_TEST(the_result_always_fails_and_is_the_last_that_did);
    RUN_TEST(a_draw_keeps_its_vertices_and_nothing_else);
    RUN_TEST(an_indexed_draw_keeps_one_triangle);
    RUN_TEST(a_shader_keeps_the_needed_instructions_with_plain_operands);
    RUN_TEST(regions_of_shaders_go_with_both_their_ends);
    RUN_TEST(a_texture_becomes_small_and_plain);
    RUN_TEST(the_same_text_gives_the_same_result);
    RUN_TEST(making_it_smaller_again_changes_nothing);
    return UNITY_END();
}
