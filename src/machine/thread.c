#include "machine/thread.h"

#include <stddef.h>

enum { STACK = 4 << 20 };

static pthread_attr_t attributes;
static const pthread_attr_t *made;

static void make(void)
{
    if (!pthread_attr_init(&attributes) && !pthread_attr_setstacksize(&attributes, STACK))
        made = &attributes;
}

const pthread_attr_t *thread_attributes(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make);
    return made;
}
