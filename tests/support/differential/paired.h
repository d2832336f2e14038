/* Two devices that get the same calls and must draw the same: the first emulates without span readings, the
 * second is an engine with them. */
#ifndef TESTS_SUPPORT_DIFFERENTIAL_PAIRED_H
#define TESTS_SUPPORT_DIFFERENTIAL_PAIRED_H

#include "triptych.h"

#include <unity.h>

enum { PAIRED_DEVICES = 2, PAIRED_SIDE = 256, PAIRED_PIXELS = PAIRED_SIDE * PAIRED_SIDE };

extern triptych_device *paired_device[PAIRED_DEVICES];

/* PAIRED_OK fails the test if a call of device `which` does. PAIRED makes a call for each, as `which`. */
#define PAIRED_OK(which, call)                                                                               \
    TEST_ASSERT_EQUAL_INT_MESSAGE(TRIPTYCH_OK, call, triptych_error(paired_device[which]))
#define PAIRED(call)                                                                                         \
    for (int which = 0; which < PAIRED_DEVICES; which++)                                                     \
    PAIRED_OK(which, call)

/* Opens both with `threads` threads: targets of PAIRED_SIDE x PAIRED_SIDE pixels, the vertices of `fvf`, no
 * lights, no depth test, no culling. */
void paired_open(const char *engine, unsigned threads, uint32_t fvf);

void paired_close(void);

/* Fails the test if the colours of the targets differ. */
void paired_expect_equal(void);

/* Returns the number of pixel routines of the second device. */
unsigned paired_pixel_routines(void);

#endif
