/* The states of draws: the keys of the three units, as sets, counted by frame. */
#ifndef COMMAND_COUNT_STATES_H
#define COMMAND_COUNT_STATES_H

#include "base/hash.h"
#include "contract/key.h"

#include <stdbool.h>
#include <stddef.h>

/* Hashes of 64 bits, each with the frame that met it last. Two keys with one hash count as one. */
struct count_states_set {
    struct count_states_item {
        uint64_t hash;
        uint32_t frame;
    } * item;
    size_t count;
    struct hash_table table;
};

struct count_states_frame {
    unsigned draws;
    unsigned states;  /* different sets of keys */
    unsigned fresh;   /* of these, sets that no frame before had */
    unsigned changes; /* draws whose set is not that of the draw before */
    unsigned returns; /* of these, draws whose set the frame had before */
};

/* Zero is empty. */
struct count_states {
    struct count_states_set sets, keys[UNIT_COUNT];
    struct count_states_frame frame; /* the current one */
    uint32_t frames;
    uint64_t last; /* the hash of the last draw's set */
    bool failed;   /* memory was refused */
};

void count_states_begin_frame(struct count_states *states);
void count_states_note(struct count_states *states, const union key key[UNIT_COUNT]);
void count_states_free(struct count_states *states);

#endif
