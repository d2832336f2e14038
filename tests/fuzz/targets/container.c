/* Draw streams as containers: as they are; as if all checksums were right; and what can be salvaged of them. */
#include "stream/container.h"
#include "tests/fuzz/targets/survive.h"
#include "tests/fuzz/targets/target.h"

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
    read_with(0, data, bytes);
    read_with(CHUNK_IGNORE_CHECKSUMS, data, bytes);
    read_with(CHUNK_IGNORE_CHECKSUMS | CONTAINER_SALVAGE, data, bytes);
}

const struct fuzz_target fuzz_container = {"container", run};
