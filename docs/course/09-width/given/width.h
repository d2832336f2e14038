/* Lab 9: one recording, compiled for 1, 4, 8 and 16 lanes. */
#ifndef WIDTH_H
#define WIDTH_H

#include <stddef.h>
#include <stdint.h>

/* --- Recordings ---
 *
 * The number of an operation is the name of its result. Operands are numbers of earlier operations. */
enum operation { OPERATION_LOAD, OPERATION_MULTIPLY, OPERATION_ADD, OPERATION_STORE };

struct recorded {
    enum operation operation;
    int left, right; /* of multiply and add; a store has only `left` */
    int index;       /* load: of the input, store: of the output */
    int part;        /* 0, or 1 for the second register of a value */
};

enum { RECORDING_MAXIMUM = 512, INPUTS = 8, OUTPUTS = 4 };

struct recording {
    int count;
    struct recorded at[RECORDING_MAXIMUM];
};

/* given/shader.c: the recording of a shader with INPUTS inputs and OUTPUTS outputs, without parts. */
void shader_record(struct recording *recording);

/* --- Registers ---
 *
 * given/allocate.c: linear scan, as in lab 8. A result is in a register from 0 to REGISTERS - 1, or in a slot
 * of the frame; the other one is -1. Registers 14 and 15 are free for operands and results in slots. */
enum { REGISTERS = 14, SCRATCH_LEFT = 14, SCRATCH_RIGHT = 15 };

struct place {
    int reg, slot;
};

void allocate(const struct recording *recording, struct place *place);

/* --- encode.c: single instructions ---
 *
 * Each appends an instruction at *at, and moves *at past it. `lanes` is 1, 4 or 8: the numbers that the
 * instruction computes. */
enum base { BASE_FRAME = 2, BASE_OUTPUT = 6, BASE_INPUT = 7 }; /* rdx, rsi, rdi */

void encode_load(uint8_t **at, int lanes, int reg, enum base base, int displacement);
void encode_store(uint8_t **at, int lanes, int reg, enum base base, int displacement);
void encode_multiply(uint8_t **at, int lanes, int to, int left, int right);
void encode_add(uint8_t **at, int lanes, int to, int left, int right);
void encode_return(uint8_t **at);

/* --- generate.c --- */

/* The numbers of one input or output of 16 elements follow each other: input i of element e is
 * in[16 * i + e]. A routine for fewer lanes is called for the first elements, then with moved pointers for
 * the next. The frame has room for 64 slots of 32 bytes. */
typedef void shader_function(const float *in, float *out, float *frame);
enum { BLOCK = 16, FRAME_FLOATS = 64 * 8 };

/* Splits each operation into two parts, one after the other: operation n becomes the operations 2 n and
 * 2 n + 1, whose operands are the same part of their operands. */
void split(const struct recording *recording, struct recording *parts);

/* Generates the code for 1, 4, 8 or 16 lanes, at most `room` bytes. A value of 16 lanes has two registers of
 * 8 lanes each. Returns the size of the code, or 0 if the lanes are not supported or the room is too
 * small. */
size_t generate(const struct recording *recording, int lanes, uint8_t *code, size_t room);

#endif
