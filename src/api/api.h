/* The public functions of triptych.h. They refuse null pointers, and the device refuses everything else.
 * Successful calls are recorded (capture/record.h). The device keeps the reason of a failure for
 * triptych_error(). */
#ifndef API_API_H
#define API_API_H

#include "capture/record.h"
#include "render/device/device.h"

/* Begin a public function that needs a device, and arguments that are given. Return the error that
 * api_finish keeps. Return null, with the reason kept, if a pointer is null: the function then returns
 * TRIPTYCH_BAD_ARGUMENT. */
struct error *api_begin(triptych_device *device);
struct error *api_begin_with(triptych_device *device, bool given, const char *name);
struct error *api_begin_with_both(triptych_device *device, bool first, const char *first_name, bool second,
                                  const char *second_name);

/* Ends a public function. If it failed, the device keeps the error for triptych_error(). Returns the
 * result. */
enum triptych_result api_finish(triptych_device *device, enum triptych_result result);

/* Ends a public function that has changed the state, and with it these parts of the derived state
 * (render/derive/change.h). */
enum triptych_result api_changed(triptych_device *device, enum triptych_result result, unsigned parts);

#endif
