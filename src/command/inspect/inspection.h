/* The reports of `triptych inspect` as JSON. The text for people is made from the same values (print.h).
 *
 * Memory that cJSON is refused marks the report incomplete (command/support/json.h). */
#ifndef COMMAND_INSPECT_INSPECTION_H
#define COMMAND_INSPECT_INSPECTION_H

#include "command/inspect/question.h"
#include "command/stream/stream.h"

#include <cjson/cJSON.h>

struct trail;

/* Plays the frame up to the draw (trail.h). The stream must outlive the trail. Null with the reason. */
struct trail *inspection_open(const struct stream *stream, const struct trail_options *options,
                              struct error *error);
void inspection_close(struct trail *trail);

/* The draws up to the draw: number, call, primitives, and the pixels that they cover. */
cJSON *inspection_draws(struct trail *trail);

/* The draw: its number, call, targets, states that differ from the default, textures, buffers, shaders. */
cJSON *inspection_state(struct trail *trail);

/* The history of the pixel in the canvas of the draw (history.c). The reason is set if the pixel is
 * outside. */
cJSON *inspection_history(struct trail *trail, struct error *error);

/* Returns true if row 0 of the canvas is the lower one of the picture. */
bool inspection_is_lower(const struct trail *trail);

/* How often each pixel of the canvas of the draw was counted. */
const uint32_t *inspection_counts(const struct trail *trail, unsigned *width, unsigned *height);

/* The primitive that each pixel of the canvas shows, in the same rows. */
const struct watch_owner *inspection_owners(const struct trail *trail);

/* Returns true if other memory than cJSON's was refused: the reports are incomplete. */
bool inspection_is_starved(const struct trail *trail);

#endif
