/* A program that makes random calls of Direct3D 9, valid and invalid ones, through the dispatcher as the
 * Windows side does. It only keeps to what a caller of COM cannot break: it calls methods of objects that it
 * references, with addresses that are null or valid. All follows from a seed, so that the first N calls of a
 * longer run are those of a run with N calls. */
#ifndef TESTS_SUPPORT_FRONT_CALLER_H
#define TESTS_SUPPORT_FRONT_CALLER_H

#include "front/d3d9/object.h"
#include "front/d3d9/remote/form.h"

enum { CALLER_OBJECTS = 256 };

struct caller {
    uint64_t seed;
    struct {
        struct d3d9_object *object;
        uint32_t references; /* of the program */
    } held[CALLER_OBJECTS];
    unsigned count;
    void *memory[16]; /* of the arguments of a call */
    unsigned memories;
    uint64_t digest;          /* of results that do not depend on time and on addresses */
    unsigned calls;           /* made since the start */
    int interfaces;           /* of the program in private data */
    const char *class, *name; /* of the last call */
};

/* Makes an adapter, a factory and a device. */
void caller_begin(struct caller *, uint64_t seed);
/* Makes a random call. The test fails if its result is not one of Direct3D's. */
void caller_call(struct caller *);
/* Releases everything. The test fails if the program's memory or interfaces are still in use. */
void caller_end(struct caller *);

#endif
