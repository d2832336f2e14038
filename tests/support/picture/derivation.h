/* The fixture of the tests of derivation: the state of a draw of lit triangles with every common attribute to
 * a target of 640 x 480, and the keys and the job of this state. */
#ifndef TESTS_SUPPORT_PICTURE_DERIVATION_H
#define TESTS_SUPPORT_PICTURE_DERIVATION_H

#include "render/derive/derive.h"

#include <unity.h>

extern struct state state;
extern struct triptych_buffer buffer;   /* the attributes' data */
extern struct triptych_texture texture; /* 64 x 48, one level, not bound */
extern union key key[UNIT_COUNT];
extern struct job job;

/* Sets all of these to their values at the beginning of a test. */
void derivation_begin(void);

/* Binds an attribute at offset 16 of vertices of 32 bytes. */
void bind_attribute(enum triptych_attribute attribute, enum triptych_format format);

#define SET(name, word)            set_word(TRIPTYCH_RENDER_STATES, 0, STATE_##name, word)
#define SET_SAMPLER(i, name, word) set_word(TRIPTYCH_SAMPLER_STATES, i, SAMPLER_##name, word)
#define SET_STAGE(i, name, word)   set_word(TRIPTYCH_STAGE_STATES, i, STAGE_##name, word)

void set_word(enum triptych_state_table table, unsigned i, unsigned row, const char *word);
void set_value(enum triptych_state which, uint32_t value);

/* Changes the texture's description. */
void describe_texture(enum triptych_texture_type type, unsigned width, unsigned height, unsigned depth,
                      unsigned levels);

/* Derives keys and job for triangles. */
void derive(void);

/* Derives, calls `change` to change the state, and fails unless the keys are the same. */
void expect_same_keys(void (*change)(void));

#endif
