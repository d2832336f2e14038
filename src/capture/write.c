#include "capture/write.h"

static void begin_record(struct record_writer *writer, uint32_t type)
{
    writer->codec.bytes = 0;
    codec_u8(&writer->codec, type, 0, "");
}

static void end_record(struct record_writer *writer)
{
    if (writer->codec.failed)
        record_write_fail(writer, writer->codec.error.text);
    chunk_record(&writer->chunks, writer->codec.data, writer->codec.bytes);
}

void record_write_fail(struct record_writer *writer, const char *reason)
{
    if (!writer->chunks.failed)
        error_set(&writer->chunks.error, "%s: %s", writer->chunks.file.name, reason);
    writer->chunks.failed = true;
}

void record_write_call(struct record_writer *writer, const struct call *call)
{
    struct call copy = *call;
    begin_record(writer, call->type);
    call_code(&writer->codec, &copy);
    end_record(writer);
    if (call->type == CALL_FRAME)
        chunk_frame(&writer->chunks);
}

void record_write_definition(struct record_writer *writer, uint32_t number, const struct resource *resource)
{
    struct resource_part parts[RESOURCE_PARTS];
    struct resource copy = *resource;
    begin_record(writer, RECORD_DEFINE);
    codec_u32(&writer->codec, number, 0, "");
    codec_u8(&writer->codec, copy.type, 0, "");
    resource_code(&writer->codec, &copy);
    end_record(writer);
    unsigned count = resource_parts(&copy, parts);
    for (unsigned i = 0; i < count; i++)
        chunk_data(&writer->chunks, parts[i].data, parts[i].bytes);
}

void record_write_end(struct record_writer *writer)
{
    begin_record(writer, RECORD_END);
    end_record(writer);
}
