/* The costs of handing work over to another thread, measured on this machine with two threads. */
#ifndef COMMAND_SIMULATE_HANDOVER_H
#define COMMAND_SIMULATE_HANDOVER_H

#include "base/error.h"

/* Nanoseconds, medians. */
struct handover {
    double enter_ns; /* from the beginning of a phase to the first work of a thread that polls for it */
    double wake_ns;  /* the same of a thread that sleeps */
    double leave_ns; /* from the end of the last work of another thread to the end of the phase */
    double take_ns;  /* to take a task, while another thread takes tasks from the same counter */
    double poll_ns;  /* the time after which a thread that finds no work sleeps */
};

/* Returns 0, or -1 with the reason: two threads need two processors. */
int handover_measure(struct handover *costs, struct error *error);

#endif
