#include "tests/command/fuzz/targets/survive.h"

#include "shader/program/program.h"
#include "command/container/container.h"
#include "tests/command/fuzz/targets/target.h"

#include <string.h>
#include <unistd.h>

enum { PIXELS = 4096, CALLS = 64, VERTICES = 600, STEPS = 128 };

static void expect_equal_bytes(const void *a, const void *b, size_t bytes, const char *what, const char *name)
{
    expect(!bytes || !memcmp(a, b, bytes), "%s of %s", what, name);
}

static void expect_equal_geometry(const struct resource *x, const struct resource *y)
{
    expect(x->vertex_bytes == y->vertex_bytes && x->index_count == y->index_count &&
               x->index_bits == y->index_bits,
           "%s", x->name);
    expect_equal_bytes(x->vertices, y->vertices, x->vertex_bytes, "vertices", x->name);
    expect_equal_bytes(x->indices, y->indices, (size_t)x->index_count * x->index_bits / 8, "indices",
                       x->name);
}

static void expect_equal_resources(const struct stream *a, const struct stream *b)
{
    expect(a->resource_count == b->resource_count, "%u and %u", a->resource_count, b->resource_count);
    for (uint32_t i = 0; i < a->resource_count; i++) {
        const struct resource *x = &a->resources[i], *y = &b->resources[i];
        expect(x->type == y->type, "%s", x->name);
        if (resource_has_geometry(x))
            expect_equal_geometry(x, y);
        if (x->type == RESOURCE_TEXTURE) {
            expect(x->texel_bytes == y->texel_bytes, "%s", x->name);
            expect_equal_bytes(x->texels, y->texels, x->texel_bytes, "texels", x->name);
        }
        if (x->type == RESOURCE_SHADER)
            expect(x->program == y->program, "the program of %s", x->name);
    }
}

/* Fails unless the stream has this text, whether it was read from text or from a container. */
static void expect_text(const struct stream *stream, const char *once, size_t bytes)
{
    struct error error = {{0}};
    char *twice;
    size_t bytes_again;
    expect(!stream_write(stream, "fuzz.tri", &twice, &bytes_again, &error), "%s", error.text);
    expect(bytes == bytes_again && !memcmp(once, twice, bytes), "%s\n%s", once, twice);
    free(twice);
}

static void expect_equal(const struct stream *stream, const struct stream *again, const char *once,
                         size_t bytes)
{
    expect_text(again, once, bytes);
    expect(stream->executed_count == again->executed_count, "%u", again->executed_count);
    expect(stream->frame_count == again->frame_count, "%u", again->frame_count);
    expect_equal_resources(stream, again);
}

static void expect_survives_text(const struct stream *stream, const char *once, size_t bytes)
{
    struct error error = {{0}};
    struct stream *again;
    expect(!stream_parse("fuzz.tri", once, bytes, &again, &error), "%s\n%s", error.text, once);
    expect_equal(stream, again, once, bytes);
    stream_free(again);
}

static void expect_survives_container(const struct stream *stream, const char *once, size_t bytes)
{
    struct error error = {{0}};
    struct stream *again;
    const char *path = fuzz_path("trib");
    expect(!container_save(stream, path, &error), "%s", error.text);
    fuzz_files = 1;
    expect(!container_read(path, 0, &again, &error), "%s", error.text);
    fuzz_files = 0;
    unlink(path);
    expect_equal(stream, again, once, bytes);
    stream_free(again);
}

/* Returns 1 if the program is short. Valid loops can execute a million instructions for each pixel. */
static int is_short(const struct program *program)
{
    for (uint32_t i = 0; i < program->steps; i++) {
        enum shader_opcode opcode = program->step[i].instruction.opcode;
        if (opcode == SHADER_LOOP || opcode == SHADER_REP || opcode == SHADER_CALL || opcode == SHADER_CALLNZ)
            return 0;
    }
    return program->steps <= STEPS;
}

int is_small_resource(const struct resource *resource)
{
    if (resource->type == RESOURCE_TEXTURE)
        return resource->texel_bytes <= 4 * PIXELS;
    return resource->type != RESOURCE_SHADER || is_short(resource->program);
}

int is_small_call(const struct stream *stream, const struct call *call)
{
    switch (call->type) {
    case CALL_TARGET:
        return (uint64_t)call->target.width * call->target.height *
                   (call->target.samples ? call->target.samples : 1) <=
               PIXELS;
    case CALL_DRAW: return call->draw.count <= VERTICES;
    case CALL_DRAW_INDEXED: return call->draw_indexed.count <= VERTICES;
    case CALL_DRAW_USER: return call->draw_user.count <= VERTICES;
    case CALL_DRAW_INDEXED_USER: return call->draw_indexed_user.count <= VERTICES;
    case CALL_DRAW_MESH: return stream->resources[call->resource].index_count <= VERTICES;
    case CALL_FREQUENCY: return 0;
    default: return 1;
    }
}

static int is_small(const struct stream *stream)
{
    for (uint32_t i = 0; i < stream->resource_count; i++)
        if (!is_small_resource(&stream->resources[i]))
            return 0;
    for (uint32_t i = 0; i < stream->call_count; i++)
        if (!is_small_call(stream, &stream->calls[i]))
            return 0;
    return stream->executed_count <= CALLS && stream->frame_count <= CALLS;
}

/* The device must accept what the check accepts. */
static void expect_plays(const struct stream *stream)
{
    static const struct triptych_options options = {.engine = "emulate", .threads = 1};
    struct error error = {{0}};
    triptych_device *device;
    expect(!triptych_device_create(&options, &device, NULL, 0), "a device");
    int result = stream_play(stream, device, 0, stream->frame_count - 1, NULL, NULL, &error);
    triptych_device_destroy(device);
    expect(!result, "%s", error.text);
}

void expect_survives(const struct stream *stream)
{
    struct error error = {{0}};
    char *text;
    size_t bytes;
    expect(!stream_write(stream, "fuzz.tri", &text, &bytes, &error), "%s", error.text);
    expect_survives_text(stream, text, bytes);
    expect_survives_container(stream, text, bytes);
    free(text);
    if (is_small(stream))
        expect_plays(stream);
}
