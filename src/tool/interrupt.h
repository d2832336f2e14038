/* Being asked to stop: SIGINT, SIGTERM and SIGHUP.
 *
 * A command that is at work for hours and has something to tell halfway finishes what it is at, tells it, and ends with
 * the status 128 + the signal's number (130 for SIGINT). All others end by the signal, as does such a command that is
 * asked a second time; their temporary files and folders are removed. A signal that was ignored when the program began,
 * as nohup has it, stays ignored. */
#ifndef TOOL_INTERRUPT_H
#define TOOL_INTERRUPT_H

/* From here on a signal ends the program and nothing stays behind. */
void interrupt_catch(void);

/* From here on the first signal is only remembered: the command asks. */
void interrupt_wait(void);

/* The number of the signal that asked to stop; 0: none did. */
int interrupted(void);

/* "SIGINT", for reports; null while none asked to stop. */
const char *interrupt_name(void);

/* The exit status of a command that was asked to stop. */
int interrupt_status(void);

#endif
