/* The stacks of the library's threads. */
#ifndef MACHINE_THREAD_H
#define MACHINE_THREAD_H

#include <pthread.h>

/* Returns the attributes of a thread with a stack of 4 MiB. By default the C library would take the process's
 * limit (RLIMIT_STACK), which can be a few KiB. Returns null, for the default, if that size is refused. */
const pthread_attr_t *thread_attributes(void);

#endif
