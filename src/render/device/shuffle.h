/* The order in which a device hands out its tasks, for tests and tools. */
#ifndef RENDER_DEVICE_SHUFFLE_H
#define RENDER_DEVICE_SHUFFLE_H

#include <stdint.h>

struct triptych_device;

/* From now on chunks and tiles are handed out in a random order, a new one each time, from this seed
 * (render/queue/phase.h); 0: in order. The image is the same. */
void device_shuffle(struct triptych_device *device, uint64_t seed);

#endif
