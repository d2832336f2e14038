#include "device.h"

#include "front/common/renderer.h"

#include <stdlib.h>

static bool make_lock(pthread_mutex_t *lock)
{
    pthread_mutexattr_t attributes;
    if (pthread_mutexattr_init(&attributes))
        return false;
    pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_RECURSIVE);
    bool made = !pthread_mutex_init(lock, &attributes);
    pthread_mutexattr_destroy(&attributes);
    return made;
}

struct gl_device *gl_device_create(void)
{
    struct gl_device *device = calloc(1, sizeof *device);
    if (!device)
        return NULL;
    if (!make_lock(&device->lock)) {
        free(device);
        return NULL;
    }
    if (front_renderer_create(&device->renderer)) {
        pthread_mutex_destroy(&device->lock);
        free(device);
        return NULL;
    }
    device->holders = 1;
    front_statistics_begin(&device->statistics);
    return device;
}

struct gl_device *gl_device_hold(struct gl_device *device)
{
    gl_device_enter(device, NULL);
    device->holders++;
    gl_device_leave(device);
    return device;
}

void gl_device_drop(struct gl_device *device)
{
    if (!device)
        return;
    gl_device_enter(device, NULL);
    unsigned holders = --device->holders;
    gl_device_leave(device);
    if (holders)
        return;
    front_statistics_end(&device->statistics, device->renderer);
    triptych_device_destroy(device->renderer);
    pthread_mutex_destroy(&device->lock);
    free(device);
}

bool gl_device_enter(struct gl_device *device, const void *context)
{
    pthread_mutex_lock(&device->lock);
    if (!context || device->last == context)
        return false;
    device->last = context;
    return true;
}

void gl_device_leave(struct gl_device *device)
{
    pthread_mutex_unlock(&device->lock);
}

void gl_device_forget(struct gl_device *device)
{
    device->last = NULL;
}
