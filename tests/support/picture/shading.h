/* Runs vertex routines without the rest of the pipeline, on each engine in turn. Their outputs for a state
 * are compared as numbers, not as pictures. */
#ifndef TESTS_SUPPORT_PICTURE_SHADING_H
#define TESTS_SUPPORT_PICTURE_SHADING_H

#include "base/bits.h"
#include "contract/arguments.h"
#include "render/state/state.h"

#include <unity.h>

extern struct state shading_state;                 /* tests change it; at first the defaults and a viewport */
extern float shaded[SLOT_COUNT * VERTEX_CAPACITY]; /* the batch that the last run wrote */
extern union key shading_key[UNIT_COUNT];          /* the keys of the last run */
extern struct job shading_job;

/* Varyings that are read in every state, in addition to those that the state needs; all 0 when a test
 * begins. */
extern uint8_t shading_varying[VARYING_COUNT];

/* The palette of indexed vertex blending; null when a test begins. */
extern const struct palette_entry *shading_palette;

/* The primitive of the vertices; triangles when a test begins. */
extern enum primitive shading_primitive;

/* Runs a test once for every engine that can run here, each time from the default state. */
void shading_on_every_engine(void (*test)(void));

/* Derives the state and shades vertices 0 to count - 1 (at most VERTEX_CAPACITY). */
void shade(uint32_t count);

/* Returns the word of a slot for a vertex. */
static inline float shaded_slot(int slot, uint32_t vertex)
{
    return shaded[slot * VERTEX_CAPACITY + vertex];
}

/* Declares an attribute of consecutive vertices in memory that exists until the test ends. */
void shading_bind(enum triptych_attribute attribute, enum triptych_format format, const void *data,
                  size_t stride);

/* Set a state to a word, a number or a real number. */
#define SHADING_SET(name, word)     shading_set(TRIPTYCH_RENDER_STATES, 0, STATE_##name, word)
#define SHADING_NUMBER(name, value) shading_number(TRIPTYCH_RENDER_STATES, 0, STATE_##name, value)
#define SHADING_REAL(name, value)                                                                            \
    shading_number(TRIPTYCH_RENDER_STATES, 0, STATE_##name, bits_of_float(value))
void shading_set(enum triptych_state_table table, unsigned i, unsigned row, const char *word);
void shading_number(enum triptych_state_table table, unsigned i, unsigned row, uint32_t value);

/* Frees the memory of a test, also if it failed. tearDown calls this function. */
void shading_close(void);

#endif
