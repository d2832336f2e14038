/* The bisector: the first operation of the specification, with its line, whose value differs between two
 * engines.
 *
 *     stream --play draw by draw, both routines in each call--> the first call that differs
 *            --narrow--> one group of vertices or triangles, or one block of pixels
 *            --observe--> every value of both engines at every operation --> the first that differs
 *
 * All engines share the renderer, so an engine can be wrong only in a routine. An engine that wraps both runs
 * each call twice, on equal inputs, and continues with the result of the reference. The order of operations
 * is that of the recording, executed by the table of operations for the four lanes that differ. That also
 * shows whose value is right.
 *
 * docs/fuzzing.md describes the observation of each engine, and its limits. */
#ifndef COMMAND_FUZZ_BISECT_BISECT_H
#define COMMAND_FUZZ_BISECT_BISECT_H

#include "contract/engine.h"
#include "command/fuzz/case/text.h"
#include "ir/ir.h"
#include "command/stream/stream.h"

#include <stdbool.h>

enum { BISECT_ANY = -1 };

struct bisect_options {
    int64_t draw; /* from 0, of the whole stream: only this one; or BISECT_ANY */
    int32_t x, y; /* only this pixel; or BISECT_ANY */
    void (*progress)(uint64_t draw, uint64_t draws); /* called before each draw; or null */
};

enum bisect_outcome {
    BISECT_SAME,     /* no routine differs on any call */
    BISECT_CALL,     /* one does, but not on a part of the call: see `reason` */
    BISECT_NARROWED, /* on one group or block; what is between its operations cannot be seen: see `reason` */
    BISECT_FOUND     /* an operation, or a fragment */
};

struct bisection {
    enum bisect_outcome outcome;
    const struct engine *engine[2]; /* the reference, the other */
    uint64_t draw;                  /* from 0, of the whole stream */
    uint32_t frame, draw_of_frame;
    enum unit unit;
    char key[KEY_TEXT_CAPACITY];
    uint32_t lane; /* of the call: vertex, triangle, pixel of its block, element of a blit */
    int32_t x, y;  /* of pixels */
    uint32_t
        /* vertices: the vertex's number; triangles: the first of its vertices' places in the batch */
        element;
    uint32_t output[2]; /* the first word of the outputs that differs */
    char output_name[64];

    /* The operation; of BISECT_NARROWED the store that writes the first different word, if there is one. */
    char place[64]; /* spec/pixel/fog.h:41 */
    const char *operation;
    uint8_t type;         /* enum ir_type */
    uint32_t value[2];    /* bits, by engine */
    uint32_t expected;    /* what the table of operations makes of the recording */
    uint32_t instruction; /* of the recording */
    uint32_t visit_pass;  /* of the innermost loop, from 0; with `in_loop` */
    bool in_loop;

    char pass
        [64]; /* of the specializer: the pass that brings the difference in, or "registers and encoding" */
    char fragment[96]; /* of stage fragments: the first whose result differs */
    char reason[256];  /* why it is no more than this */
};

/* Plays the stream with both engines. Returns 0, or -1 with the reason: no such engine here, no memory, a
 * stream that cannot be played. */
int bisect(const struct stream *stream, const struct engine *reference, const struct engine *other,
           const struct bisect_options *options, struct bisection *bisection, struct error *error);

/* One line, then what belongs to it, a line each and indented: for people. */
void bisection_print(const struct bisection *bisection, struct text *out);

#endif
