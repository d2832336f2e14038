/* The file of a container: a header, then chunks, the last of which is the end.
 *
 *   header    0  8 bytes  8d 'T' 'R' 'I' 'B' 0d 0a 1a: no text begins so, and files that were sent as text do not
 *             8  u32      version, 1
 *            12  u32      1 of a recording: what is behind its last frame is no frame; else 0
 *   chunk     0  u64      XXH3-64 of all that follows in the chunk
 *             8  u32      type: "BODY", "END "
 *            12  u32      number, from 0
 *            16  u32      bytes that are stored, at most as many as there are contents
 *            20  u32      bytes of the contents, 1 to 2^20
 *            24  u32      frames that end in the contents
 *            28  u32      as at 12 of the header
 *            32  ...      the contents: as they are if there are as many stored, else one frame of zstd
 *   end       32  u64     frames of all chunks
 *             40  u64     records of all chunks
 *
 * All numbers are little-endian. The contents of the BODY chunks, one behind the other, are records and data
 * (container.h in stream/ reads them, write.h writes them); a record does not cross from one chunk into the
 * next, data do. Nothing follows the end.
 *
 * The writer writes to a temporary file and renames it at the end, so that a file without an end is one whose writer
 * was killed, and has another name. What has been read is bounded: a chunk's contents and what is stored of them. */
#ifndef CONTAINER_CHUNK_H
#define CONTAINER_CHUNK_H

#include "base/error.h"
#include "base/file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    CHUNK_FILE_HEADER = 16,
    CHUNK_HEADER = 32,
    CHUNK_END = 16,
    CHUNK_BYTES = 1 << 20, /* of contents, at most */
    CHUNK_FULL = 1 << 18,  /* the writer begins another one then */
    CONTAINER_VERSION = 1
};

/* Whether the bytes begin a container. */
bool chunk_is_container(const void *data, size_t bytes);

/* --- Writing ----------------------------------------------------------------------------------------------
 */

struct chunk_writer {
    struct file_output file;
    uint8_t *contents, *stored; /* `stored` begins with a header */
    size_t bytes;
    struct ZSTD_CCtx_s *context;
    uint32_t number, frames;
    uint64_t all_frames, all_records;
    bool recording, failed;
    struct error error; /* the first that went wrong; nothing is written from then on */
};

/* Begins a file. Returns 0 or -1 with the reason; a writer that failed to open needs no closing. */
int chunk_open(struct chunk_writer *writer, const char *path, bool recording, struct error *error);

/* Adds a record, of at most CHUNK_BYTES; data, of any length; the end of a frame. */
void chunk_record(struct chunk_writer *writer, const void *bytes, size_t count);
void chunk_data(struct chunk_writer *writer, const void *bytes, size_t count);
void chunk_frame(struct chunk_writer *writer);

/* Writes the rest and the end and gives the file its name, if nothing has failed; otherwise there is no file. */
int chunk_close(struct chunk_writer *writer, struct error *error);

/* --- Reading ----------------------------------------------------------------------------------------------
 */

/* Checksums are computed and not compared: for fuzzers. */
enum { CHUNK_IGNORE_CHECKSUMS = 1 };

struct chunk_reader {
    const char *path;
    int descriptor;        /* of a regular file, or -1: */
    const uint8_t *memory; /* all of it */
    uint64_t size, offset; /* of the file; of the next chunk */
    unsigned flags;
    uint8_t *contents, *stored;
    struct ZSTD_DCtx_s *context;
    uint32_t number;      /* of the next chunk */
    uint64_t chunk;       /* where the one that is read begins */
    size_t bytes, at;     /* of its contents, and the next of them */
    uint32_t frames;      /* that end in it */
    uint64_t all_frames;  /* in all that was read */
    uint64_t all_records; /* the caller counts them */
    bool recording, ended;
};

/* Reads the header. The path and the memory must outlive the reader, the descriptor is the caller's. */
int chunk_read_file(struct chunk_reader *reader, const char *path, int descriptor, unsigned flags,
                    struct error *error);
int chunk_read_memory(struct chunk_reader *reader, const char *path, const void *data, size_t bytes,
                      unsigned flags, struct error *error);
void chunk_reader_free(struct chunk_reader *reader);

/* Reads the next chunk's contents; at the end `ended` is set, and there are none. */
int chunk_next(struct chunk_reader *reader, struct error *error);

/* Finds the end without reading what is before it: how many frames there are. */
int chunk_find_end(const struct chunk_reader *reader, uint64_t *frames, struct error *error);

/* Sets "PATH: offset N (chunk K, byte B): REASON" for the chunk that is being read. Returns -1. */
int chunk_fail(const struct chunk_reader *reader, size_t byte, struct error *error, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

#endif
