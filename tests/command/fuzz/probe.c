/* The values of each operation in a routine. In all routines of some streams, every engine must compute the
 * values of the recording, operation by operation. The emulator's values come from a trace, and those of the
 * other engines from probes in the recording. */
#include "render/device/device.h"
#include "engines/list.h"
#include "command/fuzz/bisect/probe.h"
#include "command/stream/stream.h"

#include <unity.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An engine that draws as emulate does. At the first call of a routine, it compares the values of the other
 * engines in the same routine. */
struct looked {
    struct routine routine;
    struct routine *emulate;
    bool done;
};

static struct triptych_device *device;
static const struct engine *engines[10];
static unsigned engine_count, routines, values;
static struct interpreter *interpreter;

/* With fewer lanes than a quad, lanes may be left out. */
static void compare(const struct probing *p, const struct routine *routine, const struct observation *seen)
{
    const struct engine *engine = routine->engine;
    bool some = routine_lanes(routine) < QUAD_LANES;
    char message[KEY_TEXT_CAPACITY + 256], key[KEY_TEXT_CAPACITY];
    for (uint32_t n = 0; n < p->events.count; n++)
        for (unsigned lane = 0; lane < QUAD_LANES; lane++) {
            const struct event *event = p->events.event + n;
            const struct ir_instruction *i = &p->ir->instruction[event->instruction];
            uint32_t a = event->lane[lane], b = seen->value[n][lane];
            bool nan = (a & 0x7fffffff) > 0x7f800000 && (b & 0x7fffffff) > 0x7f800000;
            bool known = seen->known[n] >> lane & 1;
            if (known ? a == b || nan : some)
                continue;
            snprintf(message, sizeof message, "%s: %%%u %s %s:%u, lane %u: expected %08x, got %08x%s; %s %s",
                     engine->name, event->instruction, ir_op_information[i->op].name, p->ir->file[i->file],
                     i->line, lane, a, b, known ? "" : " (not seen)", unit_name[p->replay->unit],
                     key_print(p->replay->unit, p->replay->key, key));
            TEST_FAIL_MESSAGE(message);
        }
    values += p->events.count;
}

static void look_with(const struct probing *p, const struct engine *engine, const struct routine *like)
{
    struct error error = {""};
    struct observation seen;
    struct routine *routine = engine_build(engine, p->arena, like->unit, &like->key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(routine, error.text);
    TEST_ASSERT_EQUAL_INT(0, observation_start(&seen, &p->events));
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, probe_observe(p, routine, &seen, &error), error.text);
    if (probe_reading(routine) != READING_STAGES)
        compare(p, routine, &seen);
    observation_free(&seen);
    engine->free(p->arena, routine);
}

static void look(const struct routine *routine, const void *call)
{
    const struct target *target = device_rendered_target(device);
    struct replay_target planes = {target->planes * target->samples, target->depth ? target->samples : 0};
    struct replay replay;
    struct error error = {""};
    TEST_ASSERT_EQUAL_INT(0, replay_take(&replay, routine, call, &planes));
    replay.count = routine->unit == UNIT_PIXEL ? 1 : LANES_MAXIMUM;
    struct ir *ir = ir_take(routine->unit, &routine->key, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(ir, error.text);
    TEST_ASSERT_EQUAL_INT(0, replay_reserve(&replay, probe_rows(ir)));
    uint8_t *image = replay_image(&replay);
    uint32_t lane = 0;
    while (!replay_has_quad(&replay, lane))
        lane += QUAD_LANES;
    memcpy(image, replay.before, replay.output_bytes + replay.table_bytes);
    TEST_ASSERT_TRUE(interpret(interpreter, ir, &replay, image, lane, true));
    struct probing probing = {ir,          &replay, interpreter_events(interpreter), lane, device->arena,
                              interpreter, false};
    TEST_ASSERT_FALSE(probing.events.cut);
    for (unsigned i = 0; i < engine_count; i++)
        look_with(&probing, engines[i], routine);
    routines++;
    free(image);
    ir_give(ir);
    replay_free(&replay);
}

/* Calls for pixels and blits are never empty. */
static bool has_elements(enum unit unit, const void *call)
{
    switch (unit) {
    case UNIT_VERTEX: return ((const struct vertex_arguments *)call)->count;
    case UNIT_SETUP: return ((const struct setup_arguments *)call)->count;
    default: return true;
    }
}

static void run_looked(const void *call, const struct routine *routine)
{
    struct looked *looked = (struct looked *)(uintptr_t)routine;
    if (!looked->done && has_elements(routine->unit, call)) {
        looked->done = true;
        look(looked->emulate, call);
    }
    looked->emulate->run(call, looked->emulate);
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    struct looked *looked = calloc(1, sizeof *looked);
    TEST_ASSERT_NOT_NULL(looked);
    looked->emulate = engine_build(engine_find("emulate"), arena, unit, key, error);
    looked->routine.engine = self;
    looked->routine.run = run_looked;
    looked->routine.unit = unit;
    looked->routine.key = *key;
    return &looked->routine;
}

static void release(struct code_arena *arena, struct routine *routine)
{
    engine_find("emulate")->free(arena, ((struct looked *)(void *)routine)->emulate);
    free(routine);
}

static const struct engine engine_looked = {
    .name = "looked", .description = "", .width = LANES_MAXIMUM, .build = build, .free = release};

static void play(const char *path)
{
    struct error error = {""};
    struct stream *stream;
    const struct device_options options = {.threads = 1};
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, stream_read(path, &stream, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, device_create(&engine_looked, &options, &device, &error), error.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        0, stream_play(stream, device, 0, stream->frame_count - 1, NULL, NULL, &error), error.text);
    device_destroy(device);
    stream_free(stream);
}

static const char *const *paths;
static int path_count;

static void values_are_the_recordings(void)
{
    static const char *const names[] = {"emulate",           "batch",         "batch-8",
                                        "stitch-operation",  "specialize",    "specialize-4",
                                        "specialize-thesis", "specialize-16", "specialize-1",
                                        "specialize-8x2"};
    interpreter = interpreter_create();
    TEST_ASSERT_NOT_NULL(interpreter);
    for (unsigned i = 0; i < sizeof names / sizeof *names; i++)
        if (!engine_unavailable(engine_find(names[i])))
            engines[engine_count++] = engine_find(names[i]);
    for (int i = 0; i < path_count; i++)
        play(paths[i]);
    interpreter_free(interpreter);
    printf("%u routines, %u values\n", routines, values);
    TEST_ASSERT_GREATER_THAN_UINT(10, routines);
    TEST_ASSERT_GREATER_THAN_UINT(10000, values);
}

void setUp(void)
{
}

void tearDown(void)
{
}

/* Operands are paths of other streams. */
int main(int count, char **arguments)
{
    static const char *const few[] = {"tests/data/streams/shaders.tri", "tests/data/streams/lines.tri",
                                      "tests/data/streams/stencil-operations.tri"};
    paths = count > 1 ? (const char *const *)(arguments + 1) : few;
    path_count = count > 1 ? count - 1 : (int)(sizeof few / sizeof *few);
    UNITY_BEGIN();
    RUN_TEST(values_are_the_recordings);
    return UNITY_END();
}
