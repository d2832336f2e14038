/* A small part of a binary32 target, drawn by shaders with the same coordinates at every pixel. */
#ifndef TESTS_SUPPORT_PICTURE_PART_H
#define TESTS_SUPPORT_PICTURE_PART_H

#include "drawn.h"

enum { PART = 8 }; /* the part has PART x PART pixels, at the upper left of the target */

/* Sets the positions of the square to the part. */
void part_place(void);

/* The same, on a new binary32 target. */
void part_begin(void);

/* Draws with the same two sets of coordinates everywhere, and reads the numbers. */
void part_draw(const float zeroth[4], const float next[4]);

/* Fails unless a pixel inside of the part has these channels. */
void part_expect(const float expected[4], const char *what);

#endif
