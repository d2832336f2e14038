/* Lab 5: simpler operations with the same bits. All arithmetic is binary32, rounds to nearest, and treats
 * denormal numbers as zero, operands and results: the mode in which Triptych's engines compute. */
#ifndef RULES_H
#define RULES_H

#include <stdbool.h>

/* The possible values of a result. It is a number from low to high (infinity is a number here), NaN if
 * `nan` is true, or -0 if `negative_zero` is true. +0 counts as a number. No value is denormal. */
struct range {
    float low, high;
    bool nan, negative_zero;
};

/* --- range.c ---
 *
 * What is known of a + b, a - b and a * b if this is known of a and b. Every possible result must be in the
 * range; the check of examples expects no more than the possible ones. */
struct range range_of_add(struct range a, struct range b);
struct range range_of_subtract(struct range a, struct range b);
struct range range_of_multiply(struct range a, struct range b);

/* --- reduce.c --- */

enum node_operation {
    NODE_INPUT,    /* its range is known */
    NODE_LITERAL,  /* `literal` */
    NODE_ADD,      /* left + right */
    NODE_SUBTRACT, /* left - right */
    NODE_MULTIPLY, /* left * right */
    NODE_COPY      /* left */
};

/* One operation of a program. Operands are numbers of earlier nodes. */
struct node {
    enum node_operation operation;
    int left, right;
    float literal;
    struct range range; /* of inputs and literals at first; reduce sets the others */
};

enum { NODES_MAXIMUM = 32 };

/* Replaces operations by copies of an operand (NODE_COPY) or by the literal 0 (NODE_LITERAL), where a rule
 * applies and its condition is proved by the range of an operand:
 *
 *   y * 1 = y, 1 * y = y      y + 0 = y, 0 + y = y      y + -0 = y, -0 + y = y      y - 0 = y
 *   y * 0 = 0, 0 * y = 0      y - y = 0
 *
 * An operand that is a copy counts as what it copies. Sets the range of every node. Returns the number of
 * replaced operations. */
int reduce(struct node *program, int count);

#endif
