/* Streams read from either form, and freed. */
#include "base/file.h"
#include "command/assets/asset.h"
#include "command/container/container.h"
#include "command/text/parse.h"

#include <stdlib.h>
#include <unistd.h>

void stream_free(struct stream *stream)
{
    if (!stream)
        return;
    for (uint32_t i = 0; i < stream->resource_count; i++)
        asset_free(&stream->resources[i]);
    if (stream->streamed)
        close(stream->descriptor);
    free(stream->path);
    free(stream->resources);
    free(stream->calls);
    free(stream->executed);
    free(stream->frames);
    free(stream);
}

int stream_parse(const char *path, const char *text, size_t bytes, struct stream **stream,
                 struct error *error)
{
    *stream = NULL;
    if (chunk_is_container(text, bytes))
        return container_parse(path, text, bytes, 0, stream, error);
    return parse_stream(path, text, bytes, stream, error);
}

int stream_read(const char *path, struct stream **stream, struct error *error)
{
    char *text;
    size_t bytes;
    *stream = NULL;
    if (file_read(path, LIMIT_FILE_BYTES, &text, &bytes, error))
        return -1;
    int result = stream_parse(path, text, bytes, stream, error);
    free(text);
    return result;
}
