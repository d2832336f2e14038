/* Requests to stop: SIGINT, SIGTERM and SIGHUP.
 *
 * A command that runs for hours defers the first signal: it finishes its current step, reports its results so
 * far, and exits with the status 128 + the signal's number (130 for SIGINT). A second signal ends it
 * immediately. Every other command ends at the first signal. Temporary files and folders are removed in each
 * case. A signal that was ignored when the program began, as under nohup, stays ignored. */
#ifndef COMMAND_SUPPORT_INTERRUPT_H
#define COMMAND_SUPPORT_INTERRUPT_H

/* From this call on, a signal ends the program after its temporary files are removed. */
void interrupt_catch(void);

/* From this call on, the first signal is only recorded; the command polls interrupt_signal(). */
void interrupt_defer(void);

/* The number of the recorded signal, or 0. */
int interrupt_signal(void);

/* The signal's name for reports, such as "SIGINT"; null if none was recorded. */
const char *interrupt_name(void);

/* The exit status of a command that a deferred signal stopped. */
int interrupt_status(void);

#endif
