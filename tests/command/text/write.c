/* Canonical text: a stream written and read again is the same stream, bit for bit, and its text does not
 * change. */
#include "base/file.h"
#include "image/png.h"
#include "command/stream/stream.h"
#include "tests/support/system/everything.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <unity.h>

static struct error error;

void setUp(void)
{
    error_clear(&error);
}

void tearDown(void)
{
}

static struct stream *parse(const char *path, const char *text)
{
    struct stream *stream;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse(path, text, strlen(text), &stream, &error), error.text);
    return stream;
}

static char *write_text(const struct stream *stream, const char *path)
{
    char *text;
    size_t bytes;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_write(stream, path, &text, &bytes, &error), error.text);
    TEST_ASSERT_EQUAL_UINT64(strlen(text), bytes);
    return text;
}

static void expect_same_texture(const struct resource *a, const struct resource *b)
{
    TEST_ASSERT_EQUAL_MEMORY(&a->texture, &b->texture, sizeof a->texture);
    TEST_ASSERT_EQUAL_INT(a->source, b->source);
    TEST_ASSERT_EQUAL_INT(a->mips, b->mips);
    TEST_ASSERT_EQUAL_INT(a->changes, b->changes);
    TEST_ASSERT_EQUAL_UINT64(a->texel_bytes, b->texel_bytes);
    if (a->texels)
        TEST_ASSERT_EQUAL_MEMORY(a->texels, b->texels, a->texel_bytes);
}

static void expect_same_geometry(const struct resource *a, const struct resource *b)
{
    size_t bytes_a, bytes_b;
    TEST_ASSERT_EQUAL_MEMORY(&a->layout, &b->layout, sizeof a->layout);
    TEST_ASSERT_EQUAL_MEMORY(&a->options, &b->options, sizeof a->options);
    TEST_ASSERT_EQUAL_UINT(a->vertex_count, b->vertex_count);
    TEST_ASSERT_EQUAL_UINT(a->index_bits, b->index_bits);
    TEST_ASSERT_EQUAL_UINT(a->index_count, b->index_count);
    TEST_ASSERT_EQUAL_UINT(a->value_type, b->value_type);
    const void *data_a = resource_data(a, &bytes_a), *data_b = resource_data(b, &bytes_b);
    TEST_ASSERT_EQUAL_UINT64(bytes_a, bytes_b);
    if (bytes_a)
        TEST_ASSERT_EQUAL_MEMORY(data_a, data_b, bytes_a);
    if (a->index_count)
        TEST_ASSERT_EQUAL_MEMORY(a->indices, b->indices, (size_t)a->index_count * a->index_bits / 8);
}

static void expect_same_resource(const struct resource *a, const struct resource *b)
{
    TEST_ASSERT_EQUAL_INT(a->type, b->type);
    TEST_ASSERT_EQUAL_STRING(a->name, b->name);
    if (a->type == RESOURCE_TEXTURE)
        expect_same_texture(a, b);
    if (resource_has_geometry(a))
        expect_same_geometry(a, b);
    if (a->type == RESOURCE_SHADER) {
        TEST_ASSERT_EQUAL_PTR(a->program, b->program);
        TEST_ASSERT_EQUAL_UINT64(a->code_bytes, b->code_bytes);
    }
}

/* Fails unless the calls are equal except for their positions in the text. */
static void expect_same_call(struct call a, struct call b)
{
    a.position = b.position = (struct call_position){0};
    TEST_ASSERT_EQUAL_MEMORY(&a, &b, sizeof a);
}

static void expect_same(const struct stream *a, const struct stream *b)
{
    TEST_ASSERT_EQUAL_UINT(a->resource_count, b->resource_count);
    TEST_ASSERT_EQUAL_UINT(a->call_count, b->call_count);
    TEST_ASSERT_EQUAL_UINT(a->executed_count, b->executed_count);
    TEST_ASSERT_EQUAL_UINT(a->frame_count, b->frame_count);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(a->executed, b->executed, a->executed_count);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(a->frames, b->frames, a->frame_count + 1);
    for (uint32_t i = 0; i < a->call_count; i++)
        expect_same_call(a->calls[i], b->calls[i]);
}

/* Sequences are written at the position of their calls, after all other resources. */
static void expect_same_resources(const struct stream *a, const struct stream *b)
{
    for (uint32_t i = 0; i < a->resource_count; i++) {
        uint32_t j = 0;
        while (j < b->resource_count && strcmp(a->resources[i].name, b->resources[j].name))
            j++;
        TEST_ASSERT_TRUE(j < b->resource_count);
        expect_same_resource(&a->resources[i], &b->resources[j]);
    }
}

static void expect_round_trip(const char *path, const char *text)
{
    struct stream *first = parse(path, text);
    char *once = write_text(first, path);
    struct stream *second = parse(path, once);
    char *twice = write_text(second, path);
    expect_same(first, second);
    expect_same_resources(first, second);
    TEST_ASSERT_EQUAL_STRING(once, twice);
    stream_free(first);
    stream_free(second);
    free(once);
    free(twice);
}

static void every_call_comes_back(void)
{
    expect_round_trip("everything.tri", everything);
}

static void numbers_do_not_depend_on_the_locale(void)
{
    static const char *const with_comma[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"};
    int found = 0;
    for (int i = 0; i < 4 && !found; i++)
        found = setlocale(LC_ALL, with_comma[i]) != NULL;
    if (!found)
        TEST_IGNORE_MESSAGE("no locale with a decimal comma is installed");
    expect_round_trip("everything.tri", everything);
    setlocale(LC_ALL, "C");
}

static void the_streams_of_the_project_come_back(void)
{
    static const char *const paths[] = {"tests/data/streams/frames.tri",
                                        "tests/data/streams/meshes.tri",
                                        "tests/data/streams/vertex-buffers.tri",
                                        "bench/streams/teapot-lit.tri",
                                        "bench/streams/blend.tri",
                                        "tests/data/scenes/shadow-volume.tri",
                                        "tests/data/scenes/tunnel.tri",
                                        "tests/data/streams/shaders.tri"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        char *text;
        size_t bytes;
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_read(paths[i], 1 << 24, &text, &bytes, &error), error.text);
        expect_round_trip(paths[i], text);
        free(text);
    }
}

static void numbers_are_as_short_as_they_can_be(void)
{
    struct stream *stream = parse("a", "triptych 1\ntarget 8 8\nviewport 0 0 8 8 0 1\nclear color 0.1 1e-3 "
                                       "100000 0x1p-1 depth 0.333333333\n");
    char *text = write_text(stream, "a");
    TEST_ASSERT_EQUAL_STRING(
        "triptych 1\ntarget 8 8\nviewport 0 0 8 8 0 1\nclear color 0.1 0.001 100000 0.5 depth 0.33333334\n",
        text);
    free(text);
    stream_free(stream);
}

/* --- Paths ---------------------------------------------------------------------------------------------- */

static char folder[64];

static void make_folders(void)
{
    static const uint32_t pixel = 0xff0000ff;
    char path[128];
    strcpy(folder, "/tmp/triptych-write.XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    for (int i = 0; i < 3; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, (const char *[]){"in", "in/art \"x\"", "out"}[i]);
        TEST_ASSERT_EQUAL_INT(0, mkdir(path, 0777));
    }
    snprintf(path, sizeof path, "%s/in/art \"x\"/dot.png", folder);
    TEST_ASSERT_EQUAL_INT(0, png_save(path, 1, 1, &pixel, &error));
}

static void remove_folders(void)
{
    static const char *const names[] = {"in/art \"x\"/dot.png", "in/art \"x\"", "in", "out/b.tri", "out"};
    char path[128];
    for (int i = 0; i < 5; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        remove(path);
    }
    TEST_ASSERT_EQUAL_INT(0, rmdir(folder));
}

static const char with_file[] = "triptych 1\ntexture dot file \"art \\\"x\\\"/dot.png\"\ntarget 1 1\n";

static void paths_are_those_of_the_new_place(void)
{
    char in[128], out[128];
    struct stream *again;
    make_folders();
    snprintf(in, sizeof in, "%s/in/a.tri", folder);
    snprintf(out, sizeof out, "%s/out/b.tri", folder);
    struct stream *stream = parse(in, with_file);
    char *text = write_text(stream, in);
    TEST_ASSERT_EQUAL_STRING(with_file, text);
    free(text);
    text = write_text(stream, out);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "file \"../in/art \\\"x\\\"/dot.png\""), text);
    free(text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_save(stream, out, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_read(out, &again, &error), error.text);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0xff, 0, 0, 0xff}), again->resources[0].texels, 4);
    stream_free(again);
    stream_free(stream);
    remove_folders();
}

static void a_new_place_that_does_not_exist_is_refused(void)
{
    char in[128], *text;
    size_t bytes;
    make_folders();
    snprintf(in, sizeof in, "%s/in/a.tri", folder);
    struct stream *stream = parse(in, with_file);
    TEST_ASSERT_EQUAL_INT(-1, stream_write(stream, "/nonexistent/b.tri", &text, &bytes, &error));
    TEST_ASSERT_NULL(text);
    TEST_ASSERT_NOT_NULL(strstr(error.text, "/nonexistent/b.tri: its folder"));
    stream_free(stream);
    remove_folders();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_call_comes_back);
    RUN_TEST(numbers_do_not_depend_on_the_locale);
    RUN_TEST(the_streams_of_the_project_come_back);
    RUN_TEST(numbers_are_as_short_as_they_can_be);
    RUN_TEST(paths_are_those_of_the_new_place);
    RUN_TEST(a_new_place_that_does_not_exist_is_refused);
    return UNITY_END();
}
