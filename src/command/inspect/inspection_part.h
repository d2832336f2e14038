/* Shared by the parts of the reports: state (inspection.c) and history (history.c). */
#ifndef COMMAND_INSPECT_INSPECTION_PART_H
#define COMMAND_INSPECT_INSPECTION_PART_H

#include "command/inspect/inspection.h"
#include "command/inspect/trail.h"

/* Adds the text of a call and its position in the stream: "call", and "line" or "offset" and "byte". */
void inspection_call(struct trail *trail, uint32_t position, cJSON *object);

/* The canvas of the last draw. */
const struct trail_canvas *inspection_canvas(const struct trail *trail);

#endif
