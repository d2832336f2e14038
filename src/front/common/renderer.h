/* A device of the renderer for a program. */
#ifndef FRONT_RENDERER_H
#define FRONT_RENDERER_H

#include "triptych.h"

/* Creates a device with the engine and the threads of the environment: TRIPTYCH_ENGINE, TRIPTYCH_THREADS.
 * Prints the reason of a failure. */
enum triptych_result front_renderer_create(triptych_device **renderer);

#endif
