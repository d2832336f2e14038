/* Recordings, read record by record as during playing. Memory contains only the objects that exist at the
 * current record. Small recordings are played. */
#include "command/container/reader.h"

#include "shader/program/program.h"
#include "tests/command/fuzz/targets/frame.h"
#include "tests/command/fuzz/targets/survive.h"
#include "tests/command/fuzz/targets/target.h"

enum { STEPS = 4096 };

/* Reads to the end or to a refusal. Returns 1 if all of the recording was read and is small enough to be
 * played. */
static int walk(struct stream_reader *reader, const char *path)
{
    int small = 1;
    for (int i = 0; i < STEPS; i++) {
        struct error error = {{0}};
        struct step step;
        if (reader_next(reader, &step, &error)) {
            expect_refusal(&error, path);
            return 0;
        }
        expect(!error.text[0], "%s", error.text);
        if (step.type == RECORD_NONE)
            return small;
        if (step.type == RECORD_IS_RESOURCE)
            small &= is_small_resource(&reader_window(reader)->resources[step.number]);
        else
            small &= i < 256 && is_small_call(reader_window(reader), &step.call);
        if (step.type == RECORD_IS_CALL && step.call.type == CALL_RELEASE)
            reader_release(reader, step.call.resource);
    }
    return 0;
}

static void play(const struct stream *stream)
{
    static const struct triptych_options options = {.engine = "emulate", .threads = 1};
    struct error error = {{0}};
    triptych_device *device;
    expect(!triptych_device_create(&options, &device, NULL, 0), "a device");
    int result = stream_play(stream, device, 0, stream->frame_count - 1, NULL, NULL, &error);
    triptych_device_destroy(device);
    if (result)
        expect_refusal(&error, stream->path);
}

static void run(const uint8_t *data, size_t bytes)
{
    struct error error = {{0}};
    struct stream *stream;
    size_t framed;
    uint8_t *file = frame_container(data, bytes, 1, &framed);
    const char *path = fuzz_file(file, framed);
    free(file);
    if (container_open(path, &stream, &error)) {
        expect_refusal(&error, path);
        return;
    }
    struct stream_reader *reader = reader_create(stream, &error);
    expect(reader, "%s", error.text);
    int small = walk(reader, path);
    expect(!reader_rewind(reader, &error), "%s", error.text);
    expect(walk(reader, path) == small, "another way the second time");
    reader_free(reader);
    if (small && stream->frame_count <= 16)
        play(stream);
    stream_free(stream);
}

const struct fuzz_target fuzz_recording = {"recording", run};
