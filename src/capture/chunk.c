#include "capture/chunk.h"

#include "base/clock.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>
#include <zstd.h>

enum { COMPRESSION = 3 };

static const uint8_t magic[8] = {0x8d, 'T', 'R', 'I', 'B', '\r', '\n', 0x1a};

enum type { BODY = 'B' | 'O' << 8 | 'D' << 16 | 'Y' << 24, END = 'E' | 'N' << 8 | 'D' << 16 | ' ' << 24 };

static void put32(uint8_t *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(value >> 8 * i);
}

static void put64(uint8_t *at, uint64_t value)
{
    put32(at, (uint32_t)value);
    put32(at + 4, (uint32_t)(value >> 32));
}

static uint32_t get32(const uint8_t *at)
{
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static uint64_t get64(const uint8_t *at)
{
    return get32(at) | (uint64_t)get32(at + 4) << 32;
}

bool chunk_is_container(const void *data, size_t bytes)
{
    return bytes >= sizeof magic && !memcmp(data, magic, sizeof magic);
}

/* --- Writing -------------------------------------------------------------------------------------------- */

static void free_writer(struct chunk_writer *writer)
{
    free(writer->contents);
    free(writer->stored);
    ZSTD_freeCCtx(writer->context);
    writer->contents = writer->stored = NULL;
    writer->context = NULL;
}

static void append(struct chunk_writer *writer, const void *data, size_t bytes)
{
    if (!writer->failed && file_append(&writer->file, data, bytes, &writer->error))
        writer->failed = true;
}

int chunk_open(struct chunk_writer *writer, const char *path, bool recording, struct error *error)
{
    uint8_t header[CHUNK_FILE_HEADER] = {0};
    *writer = (struct chunk_writer){.contents = malloc(CHUNK_BYTES),
                                    .stored = malloc(CHUNK_HEADER + CHUNK_BYTES),
                                    .context = ZSTD_createCCtx(),
                                    .written = clock_ns(),
                                    .recording = recording};
    if (!writer->contents || !writer->stored || !writer->context) {
        free_writer(writer);
        return error_set(error, "%s: not enough memory", path);
    }
    if (file_begin(&writer->file, path, error)) {
        free_writer(writer);
        return -1;
    }
    memcpy(header, magic, sizeof magic);
    put32(header + sizeof magic, CONTAINER_VERSION);
    put32(header + 12, recording);
    append(writer, header, sizeof header);
    return 0;
}

/* Writes a chunk. `stored` has the contents after the space for the header. */
static void write_chunk(struct chunk_writer *writer, enum type type, size_t stored, size_t bytes)
{
    uint8_t *header = writer->stored;
    put32(header + 8, type);
    put32(header + 12, writer->number++);
    put32(header + 16, (uint32_t)stored);
    put32(header + 20, (uint32_t)bytes);
    put32(header + 24, writer->frames);
    put32(header + 28, writer->recording);
    put64(header, XXH3_64bits(header + 8, CHUNK_HEADER - 8 + stored));
    append(writer, header, CHUNK_HEADER + stored);
    writer->all_frames += writer->frames;
    writer->frames = 0;
}

/* Contents that zstd cannot compress are stored unchanged. */
static void flush(struct chunk_writer *writer)
{
    if (!writer->bytes || writer->failed)
        return;
    uint8_t *stored = writer->stored + CHUNK_HEADER;
    size_t bytes = ZSTD_compressCCtx(writer->context, stored, writer->bytes - 1, writer->contents,
                                     writer->bytes, COMPRESSION);
    if (ZSTD_isError(bytes)) {
        memcpy(stored, writer->contents, writer->bytes);
        bytes = writer->bytes;
    }
    write_chunk(writer, BODY, bytes, writer->bytes);
    writer->bytes = 0;
    if (writer->recording)
        writer->written = clock_ns();
}

void chunk_record(struct chunk_writer *writer, const void *bytes, size_t count)
{
    if (count > CHUNK_BYTES) {
        writer->failed = true;
        error_set(&writer->error, "a record of %zu bytes, expected at most %d", count, CHUNK_BYTES);
    }
    if (writer->bytes >= CHUNK_FULL || count > CHUNK_BYTES - writer->bytes)
        flush(writer);
    writer->all_records++;
    if (writer->failed)
        return;
    if (count) /* null without contents */
        memcpy(writer->contents + writer->bytes, bytes, count);
    writer->bytes += count;
}

void chunk_data(struct chunk_writer *writer, const void *bytes, size_t count)
{
    const uint8_t *at = bytes;
    while (count && !writer->failed) {
        size_t room = CHUNK_BYTES - writer->bytes, part = count < room ? count : room;
        memcpy(writer->contents + writer->bytes, at, part);
        writer->bytes += part;
        at += part;
        count -= part;
        if (writer->bytes == CHUNK_BYTES)
            flush(writer);
    }
}

void chunk_frame(struct chunk_writer *writer)
{
    writer->frames++;
    if (writer->recording && clock_ns() - writer->written >= CHUNK_NANOSECONDS)
        flush(writer);
}

int chunk_close(struct chunk_writer *writer, struct error *error)
{
    flush(writer);
    if (!writer->failed) {
        put64(writer->stored + CHUNK_HEADER, writer->all_frames);
        put64(writer->stored + CHUNK_HEADER + 8, writer->all_records);
        write_chunk(writer, END, CHUNK_END, CHUNK_END);
    }
    if (!writer->failed && file_commit(&writer->file, &writer->error))
        writer->failed = true;
    else if (writer->failed)
        file_discard(&writer->file);
    free_writer(writer);
    return writer->failed ? error_set(error, "%s", writer->error.text) : 0;
}

/* --- Reading -------------------------------------------------------------------------------------------- */

int chunk_fail(const struct chunk_reader *reader, size_t byte, struct error *error, const char *format, ...)
{
    char text[ERROR_CAPACITY];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return error_set(error, "%s: offset %" PRIu64 " (chunk %" PRIu32 ", byte %zu): %s", reader->path,
                     reader->chunk, reader->number ? reader->number - 1 : 0, byte, text);
}

/* Fails at the start of the next chunk. */
static int fail_next(const struct chunk_reader *reader, struct error *error, const char *reason)
{
    return error_set(error, "%s: offset %" PRIu64 " (chunk %" PRIu32 "): %s", reader->path, reader->offset,
                     reader->number, reason);
}

/* Reads bytes of the file. It is a failure if the file is too short. */
static int fetch(const struct chunk_reader *reader, uint64_t offset, void *data, size_t bytes,
                 struct error *error)
{
    uint8_t *at = data;
    if (offset > reader->size || bytes > reader->size - offset)
        return error_set(error,
                         "%s: offset %" PRIu64 ": found %" PRIu64 " bytes, expected %zu: the file is cut off",
                         reader->path, offset, offset < reader->size ? reader->size - offset : 0, bytes);
    if (reader->memory) {
        memcpy(data, reader->memory + offset, bytes);
        return 0;
    }
    while (bytes) {
        ssize_t got = pread(reader->descriptor, at, bytes, (off_t)offset);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return error_set(error, "%s: cannot read at offset %" PRIu64, reader->path, offset);
        at += got;
        bytes -= (size_t)got;
        offset += (size_t)got;
    }
    return 0;
}

static int read_header(struct chunk_reader *reader, struct error *error)
{
    uint8_t header[CHUNK_FILE_HEADER];
    if (fetch(reader, 0, header, sizeof header, error))
        return -1;
    if (!chunk_is_container(header, sizeof header))
        return error_set(error, "%s: offset 0: found another kind of file, expected a container of draws",
                         reader->path);
    uint32_t version = get32(header + sizeof magic);
    if (version != CONTAINER_VERSION)
        return error_set(error, "%s: offset 8: found version %" PRIu32 " of the format, expected %d",
                         reader->path, version, CONTAINER_VERSION);
    if (get32(header + 12) > 1)
        return error_set(error, "%s: offset 12: found %" PRIu32 ", expected 0 or 1", reader->path,
                         get32(header + 12));
    reader->recording = get32(header + 12);
    reader->offset = CHUNK_FILE_HEADER;
    return 0;
}

static int start(struct chunk_reader *reader, struct error *error)
{
    reader->contents = malloc(CHUNK_BYTES);
    reader->stored = malloc(CHUNK_HEADER + CHUNK_BYTES);
    reader->context = ZSTD_createDCtx();
    int result = -1;
    if (reader->contents && reader->stored && reader->context)
        result = read_header(reader, error);
    else
        error_set(error, "%s: not enough memory", reader->path);
    if (result)
        chunk_reader_free(reader);
    return result;
}

int chunk_read_file(struct chunk_reader *reader, const char *path, int descriptor, unsigned flags,
                    struct error *error)
{
    struct stat status;
    *reader = (struct chunk_reader){.path = path, .descriptor = descriptor, .flags = flags};
    if (fstat(descriptor, &status) || !S_ISREG(status.st_mode))
        return error_set(error, "%s: is not a regular file, expected one", path);
    reader->size = (uint64_t)status.st_size;
    return start(reader, error);
}

int chunk_read_memory(struct chunk_reader *reader, const char *path, const void *data, size_t bytes,
                      unsigned flags, struct error *error)
{
    *reader =
        (struct chunk_reader){.path = path, .descriptor = -1, .memory = data, .size = bytes, .flags = flags};
    return start(reader, error);
}

void chunk_reader_free(struct chunk_reader *reader)
{
    free(reader->contents);
    free(reader->stored);
    ZSTD_freeDCtx(reader->context);
    *reader = (struct chunk_reader){.descriptor = -1};
}

/* Checks the header of a chunk, regardless of its checksum. */
static int check_header(const struct chunk_reader *reader, const uint8_t *header, struct error *error)
{
    uint32_t type = get32(header + 8), stored = get32(header + 16), bytes = get32(header + 20);
    char reason[128] = "";
    if (type != BODY && type != END)
        snprintf(reason, sizeof reason, "found a chunk of type 0x%08" PRIx32 ", expected BODY or END", type);
    else if (get32(header + 12) != reader->number)
        snprintf(reason, sizeof reason, "found chunk %" PRIu32 ", expected %" PRIu32, get32(header + 12),
                 reader->number);
    else if (!bytes || bytes > CHUNK_BYTES || !stored || stored > bytes)
        snprintf(reason, sizeof reason,
                 "found %" PRIu32 " bytes stored for %" PRIu32 ", expected 1 to %d, and no more stored",
                 stored, bytes, CHUNK_BYTES);
    else if (get32(header + 28) != reader->recording)
        snprintf(reason, sizeof reason, "found %" PRIu32 " in the header, expected %d as in the file's",
                 get32(header + 28), reader->recording);
    return *reason ? fail_next(reader, error, reason) : 0;
}

static int unpack(struct chunk_reader *reader, size_t stored, size_t bytes, struct error *error)
{
    const uint8_t *from = reader->stored + CHUNK_HEADER;
    if (stored == bytes) {
        memcpy(reader->contents, from, bytes);
        return 0;
    }
    size_t got = ZSTD_decompressDCtx(reader->context, reader->contents, bytes, from, stored);
    if (ZSTD_isError(got))
        return fail_next(reader, error, "found contents that are not zstd's, expected one frame of it");
    return got == bytes
               ? 0
               : fail_next(reader, error, "found fewer contents than in the header, expected the same");
}

static int check_end(struct chunk_reader *reader, const uint8_t *end, struct error *error)
{
    char reason[128];
    uint64_t frames = get64(end), records = get64(end + 8);
    snprintf(reason, sizeof reason,
             "found %" PRIu64 " frames and %" PRIu64 " records before it, expected %" PRIu64 " and %" PRIu64,
             reader->all_frames, reader->all_records, frames, records);
    if (frames != reader->all_frames || records != reader->all_records)
        return fail_next(reader, error, reason);
    if (reader->offset + CHUNK_HEADER + CHUNK_END != reader->size)
        return fail_next(reader, error, "found bytes after the end, expected none");
    reader->ended = true;
    return 0;
}

/* Reads a chunk into `stored` and checks its checksum. */
static int fetch_chunk(struct chunk_reader *reader, struct error *error)
{
    uint8_t *header = reader->stored;
    if (reader->offset == reader->size)
        return fail_next(reader, error,
                         "found no end of the container: its writer did not finish, expected an END chunk");
    if (fetch(reader, reader->offset, header, CHUNK_HEADER, error) || check_header(reader, header, error))
        return -1;
    size_t stored = get32(header + 16);
    if (fetch(reader, reader->offset + CHUNK_HEADER, header + CHUNK_HEADER, stored, error))
        return -1;
    uint64_t checksum = XXH3_64bits(header + 8, CHUNK_HEADER - 8 + stored);
    if (checksum != get64(header) && !(reader->flags & CHUNK_IGNORE_CHECKSUMS))
        return fail_next(reader, error, "found another checksum than that of its bytes: the file is damaged");
    return 0;
}

int chunk_next(struct chunk_reader *reader, struct error *error)
{
    const uint8_t *header = reader->stored;
    if (fetch_chunk(reader, error))
        return -1;
    size_t stored = get32(header + 16), bytes = get32(header + 20);
    if (get32(header + 8) == END)
        return stored == CHUNK_END && bytes == CHUNK_END
                   ? check_end(reader, header + CHUNK_HEADER, error)
                   : fail_next(reader, error, "found an end of another size, expected 16 bytes");
    if (unpack(reader, stored, bytes, error))
        return -1;
    reader->chunk = reader->offset;
    reader->offset += CHUNK_HEADER + stored;
    reader->number++;
    reader->bytes = bytes;
    reader->at = 0;
    reader->frames = get32(header + 24);
    reader->all_frames += reader->frames;
    return 0;
}

int chunk_find_end(const struct chunk_reader *reader, uint64_t *frames, struct error *error)
{
    uint8_t end[CHUNK_HEADER + CHUNK_END];
    uint64_t least = CHUNK_FILE_HEADER + sizeof end;
    if (reader->size >= least && fetch(reader, reader->size - sizeof end, end, sizeof end, error))
        return -1;
    if (reader->size < least || get32(end + 8) != END || get64(end) != XXH3_64bits(end + 8, sizeof end - 8))
        return error_set(error,
                         "%s: offset %" PRIu64 ": found no end of the container: its writer did not "
                         "finish, or the file is cut off",
                         reader->path, reader->size);
    *frames = get64(end + CHUNK_HEADER);
    return 0;
}
