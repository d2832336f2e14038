/* Every setter of the interface, with variants of what it sets, and the device that they set. */
#ifndef TESTS_SUPPORT_CHANGE_SETTING_H
#define TESTS_SUPPORT_CHANGE_SETTING_H

#include "render/device/device.h"

enum { SETTING_VARIANTS = 8, SETTINGS = 27 };

extern triptych_device *setting_device;

struct setting {
    const char *name;
    void (*set)(unsigned variant);
    unsigned never_needed; /* parts that matter for what none of the situations has */
};

extern const struct setting settings[SETTINGS];

/* One of the setters. It begins and ends a query. */
void setting_count_pixels(unsigned variant);

/* Creates the device, and what is set in it. */
void setting_begin(void);

void setting_end(void);

#endif
