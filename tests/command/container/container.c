/* The container. A stream that is written and read again is the same stream, in memory and as text. A file
 * that is damaged, truncated or made by another program gives one line with the reason, or a stream that text
 * can express. */
#include "base/file.h"
#include "capture/chunk.h"
#include "command/container/container.h"
#include "tests/support/system/everything.h"

#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <unity.h>
#include <xxhash.h>

static struct error error;
static char folder[64], file[96];

void setUp(void)
{
    error_clear(&error);
    strcpy(folder, "/tmp/triptych-container.XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    snprintf(file, sizeof file, "%s/a.trib", folder);
}

void tearDown(void)
{
    unlink(file);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, rmdir(folder), "temporary files are left");
}

static struct stream *parse(const char *path, const void *text, size_t bytes)
{
    struct stream *stream;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_parse(path, text, bytes, &stream, &error), error.text);
    return stream;
}

static char *write_text(const struct stream *stream, const char *path)
{
    char *text;
    size_t bytes;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_write(stream, path, &text, &bytes, &error), error.text);
    return text;
}

struct bytes {
    char *data;
    size_t count;
};

static struct bytes load(const char *path)
{
    struct bytes bytes;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, file_read(path, 1 << 28, &bytes.data, &bytes.count, &error), error.text);
    return bytes;
}

/* Converts a stream's text to a container. */
static struct bytes pack(const char *text)
{
    struct stream *stream = parse("a.tri", text, strlen(text));
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, container_save(stream, file, &error), error.text);
    stream_free(stream);
    return load(file);
}

static int try(const void *data, size_t count, unsigned flags, struct stream **stream)
{
    error_clear(&error);
    int result = container_parse("a.trib", data, count, flags, stream, &error);
    TEST_ASSERT_EQUAL_INT_MESSAGE(result ? -1 : 0, result, error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(result != 0, *error.text != 0, error.text);
    TEST_ASSERT_NULL(strchr(error.text, '\n'));
    TEST_ASSERT_EQUAL_INT(result != 0, *stream == NULL);
    return result;
}

static void expect_refused(const void *data, size_t count, const char *reason)
{
    struct stream *stream;
    TEST_ASSERT_EQUAL_INT(-1, try(data, count, 0, &stream));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, reason), error.text);
}

/* --- Written and read again -------------------------------------------------------------------------------
 */

/* Names in the stream are relative to its folder, and another build's test may use the folder too. */
static void expect_round_trip(const char *path)
{
    char other[256], *expected, *got;
    struct bytes text = load(path);
    snprintf(other, sizeof other, "%.*s/round-trip-%d.trib", (int)(strrchr(path, '/') - path), path,
             (int)getpid());
    struct stream *stream = parse(path, text.data, text.count), *again;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, container_save(stream, other, &error), error.text);
    int result = stream_read(other, &again, &error);
    unlink(other);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, result, error.text);
    expected = write_text(stream, path);
    got = write_text(again, path);
    TEST_ASSERT_EQUAL_STRING(expected, got);
    TEST_ASSERT_EQUAL_UINT(stream->frame_count, again->frame_count);
    for (uint32_t i = 0; i < stream->resource_count; i++)
        if (stream->resources[i].type == RESOURCE_TEXTURE)
            TEST_ASSERT_EQUAL_INT(stream->resources[i].changes, again->resources[i].changes);
    stream_free(stream);
    stream_free(again);
    free(text.data);
    free(expected);
    free(got);
}

static void every_call_comes_back(void)
{
    struct bytes bytes = pack(everything);
    struct stream *stream = parse("a.tri", everything, strlen(everything)), *again;
    again = parse("a.trib", bytes.data, bytes.count);
    char *expected = write_text(stream, "a.tri"), *got = write_text(again, "a.tri");
    TEST_ASSERT_EQUAL_STRING(expected, got);
    TEST_ASSERT_EQUAL_UINT(stream->executed_count, again->executed_count);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(stream->frames, again->frames, stream->frame_count + 1);
    stream_free(stream);
    stream_free(again);
    free(bytes.data);
    free(expected);
    free(got);
}

static void streams_of_the_project_come_back(void)
{
    static const char *const patterns[] = {"tests/data/streams/*.tri", "tests/data/regressions/*.tri",
                                           "tests/data/shading/*.tri", "bench/streams/t*.tri"};
    size_t count = 0;
    for (size_t p = 0; p < sizeof patterns / sizeof *patterns; p++) {
        glob_t found = {0};
        glob(patterns[p], 0, NULL, &found);
        for (size_t i = 0; i < found.gl_pathc; i++, count++)
            expect_round_trip(found.gl_pathv[i]);
        globfree(&found);
    }
    TEST_ASSERT_GREATER_THAN_UINT64(100, count);
}

/* --- Files ------------------------------------------------------------------------------------------------
 */

/* Data is written with the name of its file only while the file has this data. */
static void data_from_a_file_stay_when_the_file_changes(void)
{
    static const char asm_text[] = "vs_2_0\ndcl_position v0\nmov oPos, v0\n";
    static const char other_text[] = "vs_2_0\ndcl_position v0\nmov oPos, -v0\n";
    char path[128], text[256], *written;
    snprintf(path, sizeof path, "%s/s.vs", folder);
    TEST_ASSERT_EQUAL_INT(0, file_write(path, asm_text, sizeof asm_text - 1, &error));
    snprintf(text, sizeof text, "triptych 1\nshader s \"%s\"\nvertexshader s\n", path);
    struct bytes bytes = pack(text);
    struct stream *stream = parse(file, bytes.data, bytes.count);
    written = write_text(stream, file);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(written, path), written);
    free(written);
    TEST_ASSERT_EQUAL_INT(0, file_write(path, other_text, sizeof other_text - 1, &error));
    written = write_text(stream, file);
    TEST_ASSERT_NOT_NULL_MESSAGE(
        strstr(written, "shader s {\n    vs_2_0\n    dcl_position v0\n    mov oPos, v0\n}"), written);
    free(written);
    unlink(path);
    written = write_text(stream, file);
    TEST_ASSERT_NOT_NULL(strstr(written, "    mov oPos, v0\n"));
    free(written);
    stream_free(stream);
    free(bytes.data);
}

static void a_mesh_without_its_file_is_written_as_data(void)
{
    char path[128], text[256], *written;
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    snprintf(path, sizeof path, "%s/m.obj", folder);
    TEST_ASSERT_EQUAL_INT(0, file_write(path, obj, sizeof obj - 1, &error));
    snprintf(text, sizeof text, "triptych 1\ntarget 4 4\nmesh m file \"%s\"\ndraw mesh m\n", path);
    struct bytes bytes = pack(text);
    unlink(path);
    struct stream *stream = parse(file, bytes.data, bytes.count), *again;
    written = write_text(stream, file);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(written, "mesh m data position:float3 normal:float3 {\n"), written);
    again = parse(file, written, strlen(written));
    TEST_ASSERT_EQUAL_MEMORY(stream->resources[0].vertices, again->resources[0].vertices,
                             stream->resources[0].vertex_bytes);
    free(written);
    stream_free(stream);
    stream_free(again);
    free(bytes.data);
}

/* --- Damage -----------------------------------------------------------------------------------------------
 */

static const char small[] =
    "triptych 1\ntarget 4 4\ntexture t 2 2 { 00000000 00000000 ffffffff 11223344 }\n"
    "sequence s\nbind texture t\nend\nplay s\nclear color 0 0 0 1\nframe\nclear depth 1\n"
    "frame\n";

static void every_truncation_is_refused(void)
{
    struct bytes bytes = pack(small);
    for (size_t count = 0; count < bytes.count; count++) {
        struct stream *stream;
        TEST_ASSERT_EQUAL_INT(-1, try(bytes.data, count, 0, &stream));
    }
    free(bytes.data);
}

static void every_flipped_bit_is_noticed(void)
{
    struct bytes bytes = pack(small);
    for (size_t bit = 0; bit < 8 * bytes.count; bit++) {
        struct stream *stream;
        bytes.data[bit / 8] ^= (char)(1 << bit % 8);
        TEST_ASSERT_EQUAL_INT(-1, try(bytes.data, bytes.count, 0, &stream));
        bytes.data[bit / 8] ^= (char)(1 << bit % 8);
    }
    free(bytes.data);
}

/* Fails unless a stream from a damaged container can be written as text that reads as the same stream. */
static void expect_sound(struct stream *stream)
{
    char *text = write_text(stream, "a.trib"), *twice;
    struct stream *again = parse("a.tri", text, strlen(text));
    twice = write_text(again, "a.tri");
    TEST_ASSERT_EQUAL_STRING(text, twice);
    stream_free(again);
    free(text);
    free(twice);
}

static void a_reader_that_ignores_checksums_is_safe(void)
{
    struct bytes bytes = pack(small);
    for (size_t bit = 0; bit < 8 * bytes.count; bit++) {
        struct stream *stream;
        bytes.data[bit / 8] ^= (char)(1 << bit % 8);
        if (!try(bytes.data, bytes.count, CHUNK_IGNORE_CHECKSUMS, &stream)) {
            expect_sound(stream);
            stream_free(stream);
        }
        bytes.data[bit / 8] ^= (char)(1 << bit % 8);
    }
    free(bytes.data);
}

/* Returns the records of all chunks of a container. */
static struct bytes unpack(const struct bytes *container)
{
    struct chunk_reader reader;
    struct bytes contents = {malloc(1 << 22), 0};
    TEST_ASSERT_EQUAL_INT(0, chunk_read_memory(&reader, "a", container->data, container->count, 0, &error));
    while (reader.all_records = UINT64_MAX, !chunk_next(&reader, &error)) {
        memcpy(contents.data + contents.count, reader.contents, reader.bytes);
        contents.count += reader.bytes;
    }
    chunk_reader_free(&reader);
    error_clear(&error);
    return contents;
}

static void put32(char *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (char)(value >> 8 * i);
}

static void put_chunk(struct bytes *bytes, const char *type, uint32_t number, const char *contents,
                      size_t count)
{
    char *at = bytes->data + bytes->count;
    memset(at, 0, CHUNK_HEADER);
    memcpy(at + 8, type, 4);
    put32(at + 12, number);
    put32(at + 16, (uint32_t)count);
    put32(at + 20, (uint32_t)count);
    memcpy(at + CHUNK_HEADER, contents, count);
    uint64_t checksum = XXH3_64bits(at + 8, CHUNK_HEADER - 8 + count);
    put32(at, (uint32_t)checksum);
    put32(at + 4, (uint32_t)(checksum >> 32));
    bytes->count += CHUNK_HEADER + count;
}

/* Returns a container of these contents with correct checksums. */
static struct bytes repack(const char *contents, size_t count)
{
    static const char header[CHUNK_FILE_HEADER + 1] = "\x8dTRIB\r\n\x1a\1\0\0\0\0\0\0\0", end[CHUNK_END];
    struct bytes bytes = {malloc(count + 256), CHUNK_FILE_HEADER};
    memcpy(bytes.data, header, CHUNK_FILE_HEADER);
    put_chunk(&bytes, "BODY", 0, contents, count);
    put_chunk(&bytes, "END ", 1, end, CHUNK_END);
    return bytes;
}

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525 + 1013904223;
    return *state >> 8;
}

/* The checksums are correct, as in a malicious file. Only the counts of frames and records are wrong;
 * salvaging does not read these. */
static void malicious_records_are_refused_or_sound(void)
{
    struct bytes container = pack(everything), contents = unpack(&container);
    uint32_t state = 5, sound = 0, refused = 0;
    for (int i = 0; i < 1500; i++) {
        struct stream *stream;
        uint32_t at = next_random(&state) % (uint32_t)contents.count;
        char kept = contents.data[at];
        int flip = kept ^ 1 << next_random(&state) % 8, other = (int)next_random(&state);
        contents.data[at] = (char)(i % 3 ? flip : other);
        struct bytes made = repack(contents.data, contents.count);
        if (try(made.data, made.count, CONTAINER_SALVAGE, &stream)) {
            refused++;
        } else {
            expect_sound(stream);
            stream_free(stream);
            sound++;
        }
        contents.data[at] = kept;
        free(made.data);
    }
    TEST_ASSERT_GREATER_THAN_UINT(100, sound);
    TEST_ASSERT_GREATER_THAN_UINT(100, refused);
    free(container.data);
    free(contents.data);
}

/* --- Chunks -----------------------------------------------------------------------------------------------
 */

static void other_versions_and_files_are_refused(void)
{
    struct bytes bytes = pack(small);
    bytes.data[8] = 2;
    expect_refused(bytes.data, bytes.count, "a.trib: offset 8: found version 2 of the format, expected 1");
    bytes.data[8] = 1;
    bytes.data[0] = 'T';
    expect_refused(bytes.data, bytes.count, "found another kind of file");
    bytes.data[0] = (char)0x8d;
    char *longer = realloc(bytes.data, bytes.count + 1);
    longer[bytes.count] = 0;
    expect_refused(longer, bytes.count + 1, "found bytes after the end");
    free(longer);
}

/* Sizes in a header are checked before memory is allocated or data are read for them. */
static void sizes_that_no_chunk_has_are_refused(void)
{
    struct bytes bytes = pack(small);
    static const struct {
        int at;
        uint32_t value;
        const char *reason;
    } rows[] = {{20, 1 << 21, "expected 1 to 1048576"},
                {20, UINT32_MAX, "expected 1 to 1048576"},
                {20, 0, "found"},
                {16, 0, "found 0 bytes stored"},
                {16, UINT32_MAX, "no more stored"},
                {12, 1, "found chunk 1, expected 0"},
                {8, 0x12345678, "chunk of type"},
                {28, 1, "found 1 in the header"},
                {28, 2, "found 2 in the header"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char kept[4], *at = bytes.data + CHUNK_FILE_HEADER + rows[i].at;
        memcpy(kept, at, 4);
        put32(at, rows[i].value);
        expect_refused(bytes.data, bytes.count, rows[i].reason);
        memcpy(at, kept, 4);
    }
    free(bytes.data);
}

/* A small file may contain large sizes. Memory is allocated only for data that the file has. */
static void missing_resources_take_no_memory(void)
{
    static const struct {
        const char *record;
        size_t bytes;
        const char *reason;
    } rows[] = {
        /* a buffer of 2^32 - 1 bytes; one of 2^30; a texture of 8192 x 8192 x 6 with levels */
        {"\x40\0\0\0\0\x03\0\0\x04\xff\xff\xff\xff\0\0\0\0", 17, "found more than 1073741824 bytes"},
        {"\x40\0\0\0\0\x03\0\0\x04\0\0\0\x40\0\0\0\0", 17, "found 0 frames"},
        {"\x40\0\0\0\0\0\0\0\x01\x15\0\0\0\0\x20\0\x20\x01\0\0\0\x02\0\0", 24,
         "found more than 1073741824 bytes"},
        {"\x40\0\0\0\0\x01\0\0\x01\0\0\x02\xff\xff\xff\xff", 16, "found more than 1073741824 bytes"},
        {"\x40\0\0\0\0\x02\0\0\x11\1\0\0\0", 13, "found indices of 17 bits"},
        {"\x40\0\0\0\0\x05\0\0\0\0\xff\xff\xff\x0f", 14, "found a shader of 268435455 bytes"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct bytes made = repack(rows[i].record, rows[i].bytes);
        if (i != 1 && i != 5)
            expect_refused(made.data, made.count, rows[i].reason);
        struct stream *stream;
        TEST_ASSERT_EQUAL_INT(-1, try(made.data, made.count, CONTAINER_SALVAGE, &stream));
        free(made.data);
    }
}

static void a_sequence_cannot_play_itself(void)
{
    static const char record[] = "\x40\0\0\0\0\x07\1\0s\x24\0\0\0\0\x41\x24\0\0\0\0";
    struct bytes made = repack(record, sizeof record - 1);
    expect_refused(made.data, made.count, "found 's' playing itself");
    free(made.data);
}

/* --- Salvaging --------------------------------------------------------------------------------------------
 */

/* A killed writer leaves chunks without an end. */
static void whole_frames_of_an_unfinished_container_are_salvaged(void)
{
    struct bytes bytes = pack(small);
    struct stream *stream;
    size_t cut = bytes.count - CHUNK_HEADER - CHUNK_END;
    expect_refused(bytes.data, cut, "found no end of the container: its writer did not finish");
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, try(bytes.data, cut, CONTAINER_SALVAGE, &stream), error.text);
    TEST_ASSERT_EQUAL_UINT(2, stream->frame_count);
    stream_free(stream);
    TEST_ASSERT_EQUAL_INT(-1, try(bytes.data, cut - 1, CONTAINER_SALVAGE, &stream));
    free(bytes.data);
}

static void a_frame_that_is_not_whole_is_left_out(void)
{
    struct bytes container = pack(small), contents = unpack(&container);
    struct bytes made = repack(contents.data, contents.count - 3);
    struct stream *stream;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, try(made.data, made.count, CONTAINER_SALVAGE, &stream), error.text);
    TEST_ASSERT_EQUAL_UINT(1, stream->frame_count);
    expect_sound(stream);
    stream_free(stream);
    free(container.data);
    free(contents.data);
    free(made.data);
}

/* After the last frame is a wrong definition, or a sequence without an end. */
static void a_wrong_record_is_left_out_with_all_after_it(void)
{
    static const struct {
        const char *record;
        size_t bytes;
        const char *reason;
    } rows[] = {
        {"\x40\x09\0\0\0\5\1\0x\0\0\6\0\0\0vs_9_9", 21, "vs_9_9"},
        {"\x40\x09\0\0\0\1\1\0x\1\0\0\x0e\1\0\0\0\xff\xff\xff\xff", 22, "udec3"},
        {"\x40\x09\0\0\0\7\1\0x\x24\0\0\0\0", 14, ""}, /* a sequence that does not end */
    };
    struct bytes container = pack(small), contents = unpack(&container);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct stream *stream;
        memcpy(contents.data + contents.count, rows[i].record, rows[i].bytes);
        struct bytes made = repack(contents.data, contents.count + rows[i].bytes);
        TEST_ASSERT_EQUAL_INT(-1, try(made.data, made.count, 0, &stream));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(error.text, rows[i].reason), error.text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, try(made.data, made.count, CONTAINER_SALVAGE, &stream), error.text);
        TEST_ASSERT_EQUAL_UINT(2, stream->frame_count);
        TEST_ASSERT_EQUAL_UINT(2, stream->resource_count);
        expect_sound(stream);
        stream_free(stream);
        free(made.data);
    }
    free(container.data);
    free(contents.data);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(every_call_comes_back);
    RUN_TEST(streams_of_the_project_come_back);
    RUN_TEST(data_from_a_file_stay_when_the_file_changes);
    RUN_TEST(a_mesh_without_its_file_is_written_as_data);
    RUN_TEST(every_truncation_is_refused);
    RUN_TEST(every_flipped_bit_is_noticed);
    RUN_TEST(a_reader_that_ignores_checksums_is_safe);
    RUN_TEST(malicious_records_are_refused_or_sound);
    RUN_TEST(other_versions_and_files_are_refused);
    RUN_TEST(sizes_that_no_chunk_has_are_refused);
    RUN_TEST(missing_resources_take_no_memory);
    RUN_TEST(a_sequence_cannot_play_itself);
    RUN_TEST(whole_frames_of_an_unfinished_container_are_salvaged);
    RUN_TEST(a_frame_that_is_not_whole_is_left_out);
    RUN_TEST(a_wrong_record_is_left_out_with_all_after_it);
    return UNITY_END();
}
