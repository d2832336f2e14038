#include "swizzle.h"

/* --- One pixel a register --- */

/* Returns the register with the operand's numbers in their places, after a shuffle if they are not. */
static int place(struct machine_instruction **at, int from, const int *source, int temporary)
{
    struct machine_instruction shuffle = {.operation = MACHINE_SHUFFLE, .result = temporary, .left = from};
    int moved = 0;
    for (int c = 0; c < COMPONENTS; c++) {
        shuffle.control[c] = source[c] < 0 ? c : source[c];
        moved |= shuffle.control[c] != c;
    }
    if (!moved)
        return from;
    *(*at)++ = shuffle;
    return temporary;
}

int translate_pixel(const struct shader_add *add, struct machine_instruction *at)
{
    struct machine_instruction *begin = at;
    struct machine_instruction blend = {
        .operation = MACHINE_BLEND, .result = add->result, .left = add->result};
    int left = place(&at, add->left, add->left_source, PIXEL_TEMPORARY);
    int right = place(&at, add->right, add->right_source, PIXEL_TEMPORARY + 1);
    int all = 1;
    for (int c = 0; c < COMPONENTS; c++) {
        blend.control[c] = add->left_source[c] >= 0;
        all &= blend.control[c];
    }
    blend.right = PIXEL_TEMPORARY;
    *at++ = (struct machine_instruction){
        .operation = MACHINE_ADD, .result = all ? add->result : blend.right, .left = left, .right = right};
    if (!all)
        *at++ = blend;
    return (int)(at - begin);
}

/* --- One component a register --- */

/* True if component c of the result is an operand of a later component. */
static int is_read_later(const struct shader_add *add, int c)
{
    for (int later = c + 1; later < COMPONENTS; later++)
        if ((add->left == add->result && add->left_source[later] == c) ||
            (add->right == add->result && add->right_source[later] == c))
            return 1;
    return 0;
}

int translate_component(const struct shader_add *add, struct machine_instruction *at)
{
    struct machine_instruction *begin = at;
    int waits[COMPONENTS] = {0};
    for (int c = 0; c < COMPONENTS; c++) {
        if (add->left_source[c] < 0)
            continue;
        waits[c] = is_read_later(add, c);
        *at++ = (struct machine_instruction){
            .operation = MACHINE_ADD,
            .result = waits[c] ? COMPONENT_TEMPORARY + c : add->result * COMPONENTS + c,
            .left = add->left * COMPONENTS + add->left_source[c],
            .right = add->right * COMPONENTS + add->right_source[c],
        };
    }
    for (int c = 0; c < COMPONENTS; c++)
        if (waits[c])
            *at++ = (struct machine_instruction){.operation = MACHINE_MOVE,
                                                 .result = add->result * COMPONENTS + c,
                                                 .left = COMPONENT_TEMPORARY + c};
    return (int)(at - begin);
}
