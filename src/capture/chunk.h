/* The file of a container: a header, then chunks. The last chunk is the end.
 *
 *   header    0  8 bytes  8d 'T' 'R' 'I' 'B' 0d 0a 1a: no text begins so, and a text transfer damages it
 *             8  u32      version, 1
 *            12  u32      1 for a recording, whose records after the last frame are ignored; else 0
 *   chunk     0  u64      XXH3-64 of the rest of the chunk
 *             8  u32      type: "BODY", "END "
 *            12  u32      number, from 0
 *            16  u32      bytes that are stored, not more than the contents
 *            20  u32      bytes of the contents, 1 to 2^20
 *            24  u32      frames that end in the contents
 *            28  u32      the word at 12 of the header
 *            32  ...      the contents, unchanged if the two sizes are equal, else one frame of zstd
 *   end       32  u64     frames of all chunks
 *             40  u64     records of all chunks
 *
 * All numbers are little-endian. The contents of the BODY chunks, concatenated, are records and data
 * (command/container reads them, write.h writes them). A record is within one chunk. Data may continue in the
 * next chunks. The file ends with the end.
 *
 * The writer writes to a temporary file and renames it at the end. A file without an end thus has another
 * name: its writer was killed. The reader's memory is bounded: the contents and the stored bytes of one
 * chunk. */
#ifndef CAPTURE_CHUNK_H
#define CAPTURE_CHUNK_H

#include "base/error.h"
#include "base/file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    CHUNK_FILE_HEADER = 16,
    CHUNK_HEADER = 32,
    CHUNK_END = 16,
    CHUNK_BYTES = 1 << 20,         /* largest contents */
    CHUNK_FULL = 1 << 18,          /* the writer starts a new chunk at this size */
    CHUNK_NANOSECONDS = 100000000, /* a recording's frame ends its chunk if the last chunk is older */
    CONTAINER_VERSION = 1
};

/* Returns true if the bytes are the start of a container. */
bool chunk_is_container(const void *data, size_t bytes);

/* --- Writing -------------------------------------------------------------------------------------------- */

struct chunk_writer {
    struct file_output file;
    uint8_t *contents, *stored; /* `stored` has space for a header */
    size_t bytes;
    struct ZSTD_CCtx_s *context;
    uint32_t number, frames;
    uint64_t all_frames, all_records;
    uint64_t written; /* of a recording: when the file or the last chunk was begun, by clock_ns() */
    bool recording, failed;
    struct error error; /* the first failure; nothing is written afterwards */
};

/* Begins a file. Returns 0 or -1 with the reason. After a failure no chunk_close is needed. */
int chunk_open(struct chunk_writer *writer, const char *path, bool recording, struct error *error);

/* Adds a record, of at most CHUNK_BYTES; data of any length; the end of a frame. The program that is recorded
 * may crash, so its frames reach the file soon. */
void chunk_record(struct chunk_writer *writer, const void *bytes, size_t count);
void chunk_data(struct chunk_writer *writer, const void *bytes, size_t count);
void chunk_frame(struct chunk_writer *writer);

/* Writes the rest and the end, and renames the file. After a failure there is no file. */
int chunk_close(struct chunk_writer *writer, struct error *error);

/* --- Reading -------------------------------------------------------------------------------------------- */

/* Checksums are not compared, for fuzzers. */
enum { CHUNK_IGNORE_CHECKSUMS = 1 };

struct chunk_reader {
    const char *path;
    int descriptor;        /* of a regular file, or -1 to read `memory` */
    const uint8_t *memory; /* the whole file */
    uint64_t size, offset; /* of the file; position of the next chunk */
    unsigned flags;
    uint8_t *contents, *stored;
    struct ZSTD_DCtx_s *context;
    uint32_t number;      /* of the next chunk */
    uint64_t chunk;       /* position of the current chunk */
    size_t bytes, at;     /* size of its contents; position of the next byte */
    uint32_t frames;      /* frames that end in it */
    uint64_t all_frames;  /* of all chunks up to it */
    uint64_t all_records; /* counted by the caller */
    bool recording, ended;
};

/* Reads the header. The path, the memory and the descriptor belong to the caller and must outlive the
 * reader. */
int chunk_read_file(struct chunk_reader *reader, const char *path, int descriptor, unsigned flags,
                    struct error *error);
int chunk_read_memory(struct chunk_reader *reader, const char *path, const void *data, size_t bytes,
                      unsigned flags, struct error *error);
void chunk_reader_free(struct chunk_reader *reader);

/* Reads the contents of the next chunk. At the end it sets `ended`, and there are no contents. */
int chunk_next(struct chunk_reader *reader, struct error *error);

/* Reads only the end, for the number of frames. */
int chunk_find_end(const struct chunk_reader *reader, uint64_t *frames, struct error *error);

/* Sets "PATH: offset N (chunk K, byte B): REASON" for the current chunk. Returns -1. */
int chunk_fail(const struct chunk_reader *reader, size_t byte, struct error *error, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

#endif
