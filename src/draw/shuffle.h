/* The order of a device's tasks, for tests and tools: in device.h's place where that is more than is wanted. */
#ifndef DRAW_SHUFFLE_H
#define DRAW_SHUFFLE_H

#include <stdint.h>

struct triptych_device;

/* From now on chunks and tiles are handed out in a random order, a new one each time, from this seed
 * (draw/frame.h); 0: in order. The image is the same. */
void device_shuffle(struct triptych_device *device, uint64_t seed);

#endif
