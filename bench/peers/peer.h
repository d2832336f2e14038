/* A renderer that is measured: what each of them does, and the process around it.
 *
 * A renderer runs in a process of its own (peer.c has its main), whose environment and processors the
 * driver (drive.c) chose before it began, because libraries read both when they are loaded. It reads
 * commands, a line each, from standard input and answers each with a line on standard output, "ok ..." or
 * "error REASON":
 *
 *   hello                      ok DESCRIPTION of the renderer
 *   open WORKLOAD              ok COLD CPU LESS BUILD: what drawing first took longer than drawing the same
 *                              again, in milliseconds of time and of the processor, medians over a few times;
 *                              the time of a frame with fewer layers; the microseconds that building code
 *                              took of the first, by the renderer's own account, or -1. "ok none": this
 *                              renderer has no part in the workload
 *   measure full|less SECONDS  ok MS CPU: of a frame (reading, shader) on average, over at least that time;
 *                              the processor's time is that of all threads
 *   image full|less FILE       ok: 1024 x 1024 RGBA8 from the top, raw
 *   close                      ok
 *
 * It ends when the input does. */
#ifndef BENCH_PEERS_PEER_H
#define BENCH_PEERS_PEER_H

#include <stdbool.h>
#include <stdint.h>

enum { SIDE = 1024, PIXELS = SIDE * SIDE };

enum kind { FRAME, LAYER, READ, BUILD };
enum rate { MPIX, MTRI, KDRAW, MS };
enum group { CORE, HIDDEN, TABLE, RECTANGLE, EXTRA };

struct workload {
    const char *name;
    enum kind kind;
    enum rate rate;
    double amount;       /* of a layer: rate = amount * layers / milliseconds */
    unsigned full, less; /* layers */
    enum group group;
    unsigned tolerance;
    unsigned stored, memory, gathers, sums; /* of a pixel, triangle or draw */
    const char *text;
};

extern const struct workload workloads[];
extern const unsigned workload_count;

const struct workload *workload_find(const char *name); /* null: none */

/* A renderer. A function that returns a reason returns null on success. */

/* From the process' arguments. `description` has room for 256 bytes. */
const char *renderer_start(int count, char **arguments, char *description);

/* Everything of the workload but what depends on its shaders and states, as if it had never been drawn.
 * The reason "none" means that the renderer has no part in it, which is not a failure. */
const char *renderer_open(const struct workload *workload);
/* Limits drawing to some pixels, or does not. */
const char *renderer_limit(bool limited);
/* Draws a frame with all layers or fewer, and waits until it is done. */
const char *renderer_frame(bool less);
/* Reads the pixels, as they come; the row at the bottom is first if *upward. */
const char *renderer_read(uint32_t *rgba, bool *upward);
/* Makes the workload's shader with other numbers in it, draws with it and waits. */
const char *renderer_build(unsigned number);
/* Microseconds that building code has taken since renderer_open, or -1. */
double renderer_build_us(void);
void renderer_close(void);

#endif
