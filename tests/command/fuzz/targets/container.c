/* Draw streams as containers. Each input is read unchanged; with all checksums corrected, or as the contents
 * of a container; and by salvaging. */
#include "command/container/container.h"
#include "tests/command/fuzz/targets/frame.h"
#include "tests/command/fuzz/targets/survive.h"
#include "tests/command/fuzz/targets/target.h"

static void read_with(unsigned flags, const uint8_t *data, size_t bytes)
{
    struct error error = {{0}};
    struct stream *stream;
    if (container_parse("fuzz.trib", data, bytes, flags, &stream, &error)) {
        expect(!stream, "a refused stream");
        expect_refusal(&error, "fuzz.trib");
        return;
    }
    expect(!error.text[0], "%s", error.text);
    expect_survives(stream);
    stream_free(stream);
}

static void run(const uint8_t *data, size_t bytes)
{
    size_t framed;
    uint8_t *file = frame_container(data, bytes, 0, &framed);
    read_with(0, data, bytes);
    read_with(0, file, framed);
    read_with(CONTAINER_SALVAGE, file, framed);
    free(file);
}

const struct fuzz_target fuzz_container = {"container", run};
