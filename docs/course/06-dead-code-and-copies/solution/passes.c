#include "program.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static void remove_instruction(struct instruction *i)
{
    memset(i, 0, sizeof *i);
}

/* Operands are replaced before the walk reaches their users, so a copy of a copy needs no second step. */
int pass_copy(struct program *program)
{
    static int source[PROGRAM_MAXIMUM]; /* of a copy, what it copies; of other values themselves */
    int count = 0;
    for (int n = 0; n < program->count; n++) {
        struct instruction *i = program->instruction + n;
        for (int o = 0; o < 3; o++)
            i->operand[o] = source[i->operand[o]];
        source[n] = n;
        if (i->kind != KIND_COPY)
            continue;
        source[n] = i->operand[0];
        remove_instruction(i);
        count++;
    }
    return count;
}

/* From back to front: all users of a value come after it, so its mark is final when the walk reaches it. */
int pass_dead(struct program *program)
{
    static bool needed[PROGRAM_MAXIMUM];
    int count = 0;
    memset(needed, 0, (size_t)program->count * sizeof *needed);
    for (int n = program->count - 1; n > 0; n--) {
        struct instruction *i = program->instruction + n;
        if (i->kind == KIND_NOTHING)
            continue;
        if (i->kind == KIND_STORE || needed[n]) {
            for (int o = 0; o < 3; o++)
                needed[i->operand[o]] = true;
        } else {
            remove_instruction(i);
            count++;
        }
    }
    return count;
}

/* The colour's outputs are "OUTPUT diffuse[0]" to "OUTPUT diffuse[3]". */
int remove_color(struct program *program)
{
    int count = 0;
    for (int n = 1; n < program->count; n++) {
        struct instruction *i = program->instruction + n;
        int component = 0;
        if (i->kind != KIND_STORE || sscanf(i->place, "OUTPUT diffuse[%d]", &component) != 1 || component > 3)
            continue;
        remove_instruction(i);
        count++;
    }
    return count;
}
