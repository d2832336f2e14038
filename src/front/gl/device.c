#include "device.h"

#include "front/common/renderer.h"

#include <stdlib.h>

static struct gl_device *devices;
static pthread_mutex_t devices_lock = PTHREAD_MUTEX_INITIALIZER;

/* Most programs end without the end of their displays. A device that a thread uses at that time is left. */
static void end(void)
{
    pthread_mutex_lock(&devices_lock);
    for (struct gl_device *device = devices; device; device = device->next) {
        if (pthread_mutex_trylock(&device->lock))
            continue;
        front_statistics_end(&device->statistics, device->renderer);
        triptych_record_stop(device->renderer);
        gl_device_leave(device);
    }
    pthread_mutex_unlock(&devices_lock);
}

static void link_device(struct gl_device *device)
{
    static bool registered;
    pthread_mutex_lock(&devices_lock);
    if (!registered)
        registered = !atexit(end);
    device->next = devices;
    devices = device;
    pthread_mutex_unlock(&devices_lock);
}

static void unlink_device(struct gl_device *device)
{
    pthread_mutex_lock(&devices_lock);
    struct gl_device **link = &devices;
    while (*link != device)
        link = &(*link)->next;
    *link = device->next;
    pthread_mutex_unlock(&devices_lock);
}

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
    link_device(device);
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
    unlink_device(device);
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
