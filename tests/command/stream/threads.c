/* Several threads, each with its own streams, devices and players. The state that they share inside the
 * library must not mix them: the registry of programs, memory that builders and recordings keep for the next
 * routine, tables that are made on first use. Each thread uses all engines, starting with another one, so
 * that equal and different engines run simultaneously. The build with the thread sanitizer runs this test
 * too. */
#include "render/device/shuffle.h"
#include "engines/list.h"
#include "command/stream/stream.h"
#include "tests/support/system/tried.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>
#include <xxhash.h>

enum { THREADS = 4, STREAMS = 3, ENGINES = 32 };

static const char *const paths[STREAMS] = {"tests/data/streams/shaders.tri", "tests/data/streams/queries.tri",
                                           "tests/data/streams/lights.tri"};

static const struct engine *engines[ENGINES];
static unsigned engine_count;
static uint64_t expected[STREAMS];

struct worker {
    pthread_t thread;
    unsigned number;
    unsigned drawn, different;
    struct error error;
};

void setUp(void)
{
}

void tearDown(void)
{
}

static int hash_target(triptych_device *device, uint64_t *hash)
{
    struct triptych_target_description target;
    triptych_get_target(device, &target);
    size_t bytes = (size_t)target.width * target.height * sizeof(uint32_t);
    uint32_t *colors = malloc(bytes);
    int bad = !colors || triptych_read_color(device, colors, bytes);
    if (!bad)
        *hash = XXH3_64bits(colors, bytes);
    free(colors);
    return bad ? -1 : 0;
}

/* Reads the stream and draws its first frame. */
static int draw(const char *path, const struct engine *engine, uint64_t *hash, struct error *error)
{
    struct triptych_options options = {.engine = engine->name, .threads = 2};
    struct stream *stream = NULL;
    triptych_device *device = NULL;
    struct player *player = NULL;
    int bad = stream_read(path, &stream, error);
    bad = bad || triptych_device_create(&options, &device, error->text, sizeof error->text);
    if (!bad)
        device_shuffle(device, 1);
    bad = bad || stream_prepare(stream, device, &player, error) || player_frame(player, 0, error) ||
          hash_target(device, hash);
    player_free(player);
    triptych_device_destroy(device);
    stream_free(stream);
    return bad ? -1 : 0;
}

static void *work(void *user)
{
    struct worker *worker = user;
    for (unsigned i = 0; i < engine_count; i++)
        for (unsigned s = 0; s < STREAMS; s++) {
            uint64_t hash = 0;
            unsigned stream = (s + worker->number) % STREAMS;
            if (draw(paths[stream], engines[(i + worker->number / 2) % engine_count], &hash, &worker->error))
                return NULL;
            worker->drawn++;
            worker->different += hash != expected[stream];
        }
    return NULL;
}

static void devices_in_different_threads_do_not_affect_each_other(void)
{
    struct worker workers[THREADS] = {{0}};
    struct error error = {""};
    for (unsigned s = 0; s < STREAMS; s++)
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, draw(paths[s], engine_find("emulate"), &expected[s], &error),
                                      error.text);
    for (unsigned i = 0; i < THREADS; i++) {
        workers[i].number = i;
        TEST_ASSERT_EQUAL_INT(0, pthread_create(&workers[i].thread, NULL, work, workers + i));
    }
    for (unsigned i = 0; i < THREADS; i++)
        pthread_join(workers[i].thread, NULL);
    for (unsigned i = 0; i < THREADS; i++) {
        TEST_ASSERT_EQUAL_STRING("", workers[i].error.text);
        TEST_ASSERT_EQUAL_UINT(STREAMS * engine_count, workers[i].drawn);
        TEST_ASSERT_EQUAL_UINT(0, workers[i].different);
    }
}

int main(void)
{
    for (unsigned i = 0; engine_at(i); i++)
        if (engine_is_tried(engine_at(i)) && engine_count < ENGINES)
            engines[engine_count++] = engine_at(i);
    UNITY_BEGIN();
    RUN_TEST(devices_in_different_threads_do_not_affect_each_other);
    return UNITY_END();
}
