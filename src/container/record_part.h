/* What the parts of the recorder share: the file (record.c), the calls (record_call.c, record_vertex.c), the beginning
 * (record_start.c). */
#ifndef CONTAINER_RECORD_PART_H
#define CONTAINER_RECORD_PART_H

#include "container/record.h"
#include "container/write.h"

struct recorder {
    struct record_writer write;
    uint32_t *free_numbers;    /* of resources that were released */
    uint32_t free_count, next; /* and the first that was never used */
    uint32_t free_capacity;
    bool drawn; /* since the last frame */
};

/* Writes a call. */
void record_call(struct recorder *recorder, const struct call *call);

/* Writes a definition, with a number of its own, and all its data. Returns the number. */
uint32_t record_define(struct recorder *recorder, const struct resource *resource);

/* Says that nothing behind this uses the resource. */
void record_release(struct recorder *recorder, uint32_t number);

/* A buffer of bytes that lives for the calls that follow. */
uint32_t record_bytes(struct recorder *recorder, const void *data, size_t bytes);

/* All elements that are declared but those whose bits are set: of attributes, of the others. An attribute by itself whose
 * buffer is gone is not declared either. */
struct left_out {
    uint64_t attributes, others;
};
void record_vertex_input(struct recorder *recorder, const struct state *state,
                         const struct left_out *left_out);

/* What the recorder knows of a device that has been running. */
void record_beginning(struct triptych_device *device);

#endif
