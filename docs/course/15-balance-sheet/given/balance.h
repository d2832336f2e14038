/* Lab 15: the work of a routine, the rates of a processor core, and the time that follows. */
#ifndef BALANCE_H
#define BALANCE_H

enum { BLOCK_PIXELS = 8 };

enum resource { INSTRUCTIONS, ARITHMETIC, LOADS, STORES, RESOURCES };

/* The work for a block of 8 pixels, by resource. An instruction can need several. */
struct needs {
    unsigned count[RESOURCES];
};

/* The instructions of each kind that one core can execute in a nanosecond, and the bytes that all cores
 * together can move to memory in a nanosecond. All are above 0. */
struct rates {
    double each[RESOURCES];
    double memory;
};

struct frame {
    double pixels;   /* of the target */
    unsigned layers; /* each layer covers all pixels */
    double bytes;    /* moved between memory and the caches for each pixel of the target, once a frame */
    unsigned threads, cores;
};

/* --- balance.c, the student's file. --- */

/* Adds an instruction, such as "vfmadd231ps ymm3, ymm2, [rsp+0x80]". README.md has the rules. */
void balance_count(struct needs *needs, const char *instruction);

/* The resource that needs the most time for a block, and this time in nanoseconds. */
enum resource balance_bottleneck(const struct needs *needs, const struct rates *rates);
double balance_block_ns(const struct needs *needs, const struct rates *rates);

/* The least time for a frame, in milliseconds: of the cores, or of the memory. */
double balance_frame_ms(const struct frame *frame, const struct needs *needs, const struct rates *rates);

#endif
