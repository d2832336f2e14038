#include "renderer.h"

#include <stdio.h>
#include <stdlib.h>

enum triptych_result front_renderer_create(triptych_device **renderer)
{
    char reason[512];
    const char *threads = getenv("TRIPTYCH_THREADS");
    const struct triptych_options options = {
        .engine = getenv("TRIPTYCH_ENGINE"),
        .threads = threads ? (unsigned)strtoul(threads, NULL, 10) : 0,
    };
    enum triptych_result result = triptych_device_create(&options, renderer, reason, sizeof reason);
    if (result)
        fprintf(stderr, "triptych: %s\n", reason);
    return result;
}
