/* The engines as the command line names them. */
#ifndef TOOL_CHOOSE_H
#define TOOL_CHOOSE_H

#include "base/error.h"
#include "tool/tool.h"

enum { CHOICE_CAPACITY = 32 };

struct choice {
    unsigned count;
    unsigned index[CHOICE_CAPACITY]; /* numbers of triptych_engine_name() */
    unsigned left_out_count;         /* engines that would be chosen if they could run here */
    struct {
        unsigned index;
        char reason[ERROR_CAPACITY];
    } left_out[CHOICE_CAPACITY];
};

/* Finds the engine of that name that can run here. `width`, unless 0, asks for the engine's variant of that
 * many lanes: itself or the one called NAME-WIDTH. Returns 0, or STATUS_BAD after telling what there is
 * instead. */
int choose_engine(const struct command *self, const char *name, unsigned width, unsigned *index);

/* Reads a comma-separated list of engines, each once and able to run here. Null: every engine that can run
 * here and does not wait to be named (engine.on_request); the others are left out. */
int choose_engines(const struct command *self, const char *list, struct choice *choice);

/* Reads a comma-separated list of thread counts. */
int choose_threads(const struct command *self, const char *list, struct choice *threads);

#endif
