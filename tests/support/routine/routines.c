#include "routines.h"

#include "tests/support/differential/differential.h"
#include "tests/support/system/seed.h"

#include "render/device/device.h"
#include "command/fuzz/case/shader.h"
#include "shader/program/program.h"
#include "shader/code/read.h"
#include "command/stream/stream.h"

#include <glob.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

static unsigned every = 4;

void visit_fewer(void)
{
    every = 9;
}

/* --- Keys that were visited, by hash ----------------------------------------------------------------- */

enum { SEEN_BITS = 14, SEEN = 1 << SEEN_BITS };

struct visit {
    routine_visitor *visit;
    void *context;
    size_t count;
    uint64_t seen[SEEN]; /* 0: free */
};

static void begin(struct visit *v, routine_visitor *visit, void *context)
{
    memset(v, 0, sizeof *v);
    v->visit = visit;
    v->context = context;
}

/* Returns 1 if the key is new. */
static int note(struct visit *v, enum unit unit, const union key *key)
{
    struct packed_key packed = key_pack(unit, key);
    uint64_t hash = key_hash(unit, &packed) | 1;
    size_t slot = hash >> (64 - SEEN_BITS);
    for (; v->seen[slot]; slot = (slot + 1) % SEEN)
        if (v->seen[slot] == hash)
            return 0;
    TEST_ASSERT_LESS_THAN(SEEN / 2, v->count);
    v->seen[slot] = hash;
    return 1;
}

static void visit_once(struct visit *v, enum unit unit, const union key *key)
{
    if (!note(v, unit, key))
        return;
    v->count++;
    v->visit(v->context, unit, key);
}

/* --- Random keys ------------------------------------------------------------------------------------- */

size_t visit_random_keys(unsigned count, uint64_t seed, routine_visitor *visit, void *context)
{
    static struct visit v;
    begin(&v, visit, context);
    for (unsigned i = 0; i < count; i++) {
        union key key;
        differential_key(i % UNIT_COUNT, &seed, &key);
        visit_once(&v, i % UNIT_COUNT, &key);
    }
    return v.count;
}

/* --- Shaders ----------------------------------------------------------------------------------------- */

/* A random key of the shader's unit, with the shader. */
static void visit_shader(struct visit *v, const struct shader *shader, uint64_t *seed)
{
    struct error error = {{0}};
    const struct program *program = program_acquire(shader, &error);
    union key key;
    TEST_ASSERT_NOT_NULL_MESSAGE(program, error.text);
    enum unit unit = program->model->stage == STAGE_VERTEX ? UNIT_VERTEX : UNIT_PIXEL;
    do
        differential_key(unit, seed, &key);
    while (unit == UNIT_VERTEX ? key_program(key.vertex.shader) : key_program(key.pixel.shader));
    key_set_program(unit == UNIT_VERTEX ? key.vertex.shader : key.pixel.shader, program->number);
    visit_once(v, unit, &key);
    program_release(program);
}

size_t visit_shaders(uint64_t seed, routine_visitor *visit, void *context)
{
    static struct visit v;
    glob_t files;
    begin(&v, visit, context);
    TEST_ASSERT_EQUAL_INT(0, glob("tests/data/shaders/*/*.?sa", 0, NULL, &files));
    for (size_t f = 0; f < files.gl_pathc; f += test_stride_of(every)) {
        struct error error = {{0}};
        struct shader *shader;
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, shader_load(files.gl_pathv[f], &shader, &error), error.text);
        visit_shader(&v, shader, &seed);
        shader_free(shader);
    }
    globfree(&files);
    return v.count;
}

size_t visit_random_shaders(unsigned count, uint64_t seed, routine_visitor *visit, void *context)
{
    static struct visit v;
    begin(&v, visit, context);
    for (unsigned i = 0; i < count; i++) {
        struct random random = random_start(seed, i);
        struct error error = {{0}};
        struct fuzz_shader made;
        const struct fuzz_shader_options options = {0};
        const struct shader_model *model = fuzz_shader_model(&random, i % 2 ? STAGE_VERTEX : STAGE_PIXEL);
        struct shader *shader = fuzz_shader_make(&random, model, &options, &made, &error);
        TEST_ASSERT_NOT_NULL_MESSAGE(shader, error.text);
        visit_shader(&v, shader, &random.state);
        shader_free(shader);
    }
    return v.count;
}

/* --- Streams ------------------------------------------------------------------------------------------ */

/* The fastest engine, because some engine has to draw. */
static triptych_device *create_device(void)
{
    struct triptych_options options = {.engine = "specialize", .threads = 1};
    triptych_device *device;
    char reason[256] = "";
    if (triptych_device_create(&options, &device, reason, sizeof reason)) {
        options.engine = "emulate";
        TEST_ASSERT_EQUAL_INT_MESSAGE(
            TRIPTYCH_OK, triptych_device_create(&options, &device, reason, sizeof reason), reason);
    }
    return device;
}

static void visit_stream(struct visit *v, const char *path)
{
    struct error error = {{0}};
    struct stream *stream = NULL;
    struct player *player = NULL;
    struct routine routine;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_read(path, &stream, &error), error.text);
    triptych_device *device = create_device();
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_prepare(stream, device, &player, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, player_frame(player, 0, &error), error.text);
    for (size_t i = 0; cache_get(device->cache, i, &routine); i++)
        visit_once(v, routine.unit, &routine.key);
    player_free(player);
    stream_free(stream);
    triptych_device_destroy(device);
}

size_t visit_streams(routine_visitor *visit, void *context)
{
    static const char *const folders[] = {"bench/streams", "tests/data/streams", "tests/data/scenes",
                                          "tests/data/shading"};
    static struct visit v;
    begin(&v, visit, context);
    for (size_t f = 0; f < sizeof folders / sizeof *folders; f++) {
        char pattern[64];
        glob_t files;
        snprintf(pattern, sizeof pattern, "%s/*.tri", folders[f]);
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, glob(pattern, 0, NULL, &files), pattern);
        for (size_t i = 0; i < files.gl_pathc; i += test_stride_of(every))
            visit_stream(&v, files.gl_pathv[i]);
        globfree(&files);
    }
    return v.count;
}
