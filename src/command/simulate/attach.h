/* A device whose queue records a timeline. */
#ifndef COMMAND_SIMULATE_ATTACH_H
#define COMMAND_SIMULATE_ATTACH_H

struct triptych_device;
struct timeline;

/* From now on the device's queue, which has one thread, records; null: not any more. */
void simulate_attach(struct triptych_device *device, struct timeline *timeline);

#endif
