/* Draw streams as text: the reader refuses them at a position, or returns a stream that passes survive.h. */
#include "capture/chunk.h"
#include "command/stream/stream.h"
#include "tests/command/fuzz/targets/survive.h"
#include "tests/command/fuzz/targets/target.h"

static void run(const uint8_t *data, size_t bytes)
{
    struct error error = {{0}};
    struct stream *stream;
    if (chunk_is_container(data, bytes))
        return;
    if (stream_parse("fuzz.tri", (const char *)data, bytes, &stream, &error)) {
        expect(!stream, "a refused stream");
        expect_refusal_at(&error, "fuzz.tri");
        return;
    }
    expect(!error.text[0], "%s", error.text);
    expect_survives(stream);
    stream_free(stream);
}

const struct fuzz_target fuzz_text = {"text", run};
