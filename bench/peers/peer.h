/* A renderer that is measured: its functions, and the protocol of its process.
 *
 * A renderer is a process (peer.c has its main). The driver (drive.c) chooses its environment and processors
 * before it starts, because libraries read both when they are loaded. The process reads commands from
 * standard input, a line each, and answers each with a line on standard output, "ok ..." or "error REASON":
 *
 *   hello                      ok DESCRIPTION of the renderer
 *   open WORKLOAD              ok COLD CPU LESS BUILD. COLD and CPU: the additional wall time and processor
 * time of
 *                              the first frame, compared with the same frame again, in milliseconds, medians
 * of a
 *                              few tries. LESS: the time of a frame with fewer layers. BUILD: the
 * microseconds of
 *                              the first frame in which code was built, as the renderer reports them, or -1.
 *                              "ok none": this renderer does not support the workload
 *   measure full|less SECONDS  ok MS CPU: the average wall time and processor time of a frame (a read, a
 * shader), over
 *                              at least this time. Processor time is that of all threads
 *   image full|less FILE       ok: writes 1024 x 1024 RGBA8 from the top, raw
 *   close                      ok
 *
 * The process ends when its input ends. */
#ifndef BENCH_PEERS_PEER_H
#define BENCH_PEERS_PEER_H

#include <stdbool.h>
#include <stdint.h>

enum { SIDE = 1024, PIXELS = SIDE * SIDE };

enum kind { FRAME, LAYER, READ, BUILD };
enum rate { MPIX, MTRI, KDRAW, MS };
enum group { CORE, HIDDEN, TABLE, RECTANGLE, EXTRA, PAGE };

struct workload {
    const char *name;
    enum kind kind;
    enum rate rate;
    double amount;       /* of work in a layer: rate = amount * layers / milliseconds */
    unsigned full, less; /* layers */
    enum group group;
    unsigned tolerance;
    unsigned stored, memory, gathers, sums; /* for a pixel, triangle or draw (workload.def) */
    const char *text;
};

extern const struct workload workloads[];
extern const unsigned workload_count;

const struct workload *workload_find(const char *name); /* null: none */

/* A renderer. A function that returns a reason returns null on success. */

/* Starts the renderer with the arguments of the process. `description` has room for 256 bytes. */
const char *renderer_start(int count, char **arguments, char *description);

/* Prepares the workload, except for its shaders and states, so that the next frame is the first one that uses
 * these. The reason "none" means that the renderer does not support the workload, which is not a failure. */
const char *renderer_open(const struct workload *workload);
/* Limits draws to some pixels, or removes the limit. */
const char *renderer_limit(bool limited);
/* Draws a frame with all layers or fewer, and waits for its end. */
const char *renderer_frame(bool less);
/* Reads the pixels in the renderer's order; the bottom row is first if *upward. */
const char *renderer_read(uint32_t *rgba, bool *upward);
/* Makes the workload's shader with another number, draws with it and waits for the end. */
const char *renderer_build(unsigned number);
/* Returns the microseconds in which code was built since renderer_open(), or -1 if unknown. */
double renderer_build_us(void);
void renderer_close(void);

#endif
