/* A program that is appended to, and what ir_verify reports. */
#ifndef TESTS_IR_PROGRAM_H
#define TESTS_IR_PROGRAM_H

#include "ir/ir.h"

#include <string.h>
#include <unity.h>

static struct ir ir;

static inline uint16_t append(enum ir_op op, enum ir_type type, uint16_t a, uint16_t b, int32_t k)
{
    ir.phis += op == IR_phi || op == IR_join;
    return ir_append(
        &ir, (struct ir_instruction){.op = (uint8_t)op, .type = (uint8_t)type, .operand = {a, b}, .k = k});
}

static inline uint16_t number(int32_t k)
{
    return append(IR_literal, TYPE_itg, 0, 0, k);
}

static inline uint16_t mask(void)
{
    return append(IR_literal, TYPE_msk, 0, 0, -1);
}

static inline uint16_t effect(enum ir_op op, uint16_t a, uint16_t b)
{
    return append(op, TYPE_non, a, b, 0);
}

static inline uint16_t set(int variable, uint16_t value)
{
    return append(IR_set, TYPE_itg, value, 0, variable);
}

static inline uint16_t get(int variable)
{
    return append(IR_get, TYPE_itg, 0, 0, variable);
}

static inline void accept(void)
{
    const char *wrong = ir_verify(&ir);
    TEST_ASSERT_NULL_MESSAGE(wrong, wrong);
}

static inline void refuse(const char *reason)
{
    const char *wrong = ir_verify(&ir);
    TEST_ASSERT_NOT_NULL_MESSAGE(wrong, reason);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(wrong, reason), wrong);
}

#endif
