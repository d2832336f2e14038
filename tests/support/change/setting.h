/* Every setter of the interface, with variants of the values that it sets, and the device that is set. */
#ifndef TESTS_SUPPORT_CHANGE_SETTING_H
#define TESTS_SUPPORT_CHANGE_SETTING_H

#include "render/device/device.h"

enum { SETTING_VARIANTS = 8, SETTINGS = 27 };

extern triptych_device *setting_device;

struct setting {
    const char *name;
    void (*set)(unsigned variant);
};

extern const struct setting settings[SETTINGS];

/* One of the setters: it begins and ends a query. */
void setting_count_pixels(unsigned variant);

/* Creates the device and the objects that the setters set. */
void setting_begin(void);

void setting_end(void);

#endif
