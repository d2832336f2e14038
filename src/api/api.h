/* The public functions of triptych.h: null pointers are refused here, everything else by the device; what has succeeded
 * is recorded (container/record.h); the reason of a failure is kept for triptych_error(). */
#ifndef API_API_H
#define API_API_H

#include "container/record.h"
#include "draw/device.h"

/* Ends a call: the reason is kept from the last failed call until the next one. Returns the result. */
enum triptych_result api_finish(triptych_device *device, enum triptych_result result,
                                const struct error *error);

/* The same, after a change of the state that may have changed these parts of what it derives to (draw/change.h). */
enum triptych_result api_changed(triptych_device *device, enum triptych_result result, unsigned parts,
                                 const struct error *error);

/* Ends a call whose argument `what` must not be null. */
enum triptych_result api_null_argument(triptych_device *device, const char *what);

#endif
