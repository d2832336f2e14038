/* Shared by the parts of the recorder: the file (record.c), calls (record_call.c, record_surface.c,
 * record_vertex.c), the beginning (record_start.c). */
#ifndef CAPTURE_RECORD_PART_H
#define CAPTURE_RECORD_PART_H

#include "capture/record.h"
#include "capture/write.h"

struct recorder {
    struct record_writer write;
    uint32_t *free_numbers;    /* numbers of released resources */
    uint32_t free_count, next; /* the first number that was never used */
    uint32_t free_capacity;
    bool drawn;            /* since the last frame */
    bool framed;           /* the application has ended a frame */
    bool from_environment; /* started by TRIPTYCH_RECORD */
    uint32_t waits;        /* of the application, after draws */
    bool waited;           /* since the last draw */
};

/* The following functions need a device with a recorder. */

/* Writes a definition with all its data. Returns its new number. */
uint32_t record_define(struct triptych_device *device, const struct resource *resource);

/* Releases a resource: no later call uses it. */
void record_release(struct triptych_device *device, uint32_t number);

/* Writes a buffer of bytes. The caller releases it. Returns its number. */
uint32_t record_bytes(struct triptych_device *device, const void *data, size_t bytes);

/* Writes the bytes of all mapped buffers, which the next draw may read. */
void record_all_mapped(struct triptych_device *device);

/* Makes the recording fail because memory for a call is missing. */
void record_memory_is_short(struct triptych_device *device);

/* Elements that a declaration leaves out: bits of attributes, bits of the other elements. */
struct left_out {
    uint64_t attributes, others;
};
void record_vertex_input(struct triptych_device *device, const struct left_out *left_out);

/* Writes a call of this type, which begins or ends a query, for each query that has begun. */
void record_open_queries(struct triptych_device *device, enum call_type type);

/* Writes the resources and the state of a device that is already running. */
void record_beginning(struct triptych_device *device);

#endif
