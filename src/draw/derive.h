/* From the state to what routines are built for and called with: the keys of the three units, and the job.
 *
 * Keys are normalised: states that draw the same thing have the same keys, so that one routine serves them
 * all and no operation is generated whose result nobody reads. What is normalised and why it is exact, is
 * said where it happens. The job is filled for these keys: its dead parts are zero. */
#ifndef DRAW_DERIVE_H
#define DRAW_DERIVE_H

#include "draw/job.h"
#include "draw/raster.h"
#include "draw/state.h"

#include <stdbool.h>

/* Farthest from the window's origin that a projected vertex may lie, in pixels; beyond it the clipper cuts.
 */
#define GUARD_BAND_PIXELS 16383.0

/* The keys, indexed by enum unit. */
void derive_keys(const struct state *state, union key key[UNIT_COUNT]);

/* Whether a draw with this key can change the target at all. */
bool derive_effective(const struct pixel_key *key);

/* The values for these keys. Attributes' data and stride come from the streams as bound; those of a stream
 * that steps with the instance are instance 0's, with stride 0, those of a stream without buffer null. */
void derive_job(const struct state *state, const struct vertex_key *vertex, const struct pixel_key *pixel,
                struct job *job);

/* The pixels whose centres lie inside the viewport and, if its test is on, the scissor rectangle. */
struct rectangle derive_scissor(const struct state *state);

#endif
