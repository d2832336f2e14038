#include "rules.h"

#include <math.h>

static int copied(const struct node *program, int number)
{
    while (program[number].operation == NODE_COPY)
        number = program[number].left;
    return number;
}

static bool is_one(const struct node *node)
{
    return node->operation == NODE_LITERAL && node->literal == 1;
}

/* True for the literal +0 or, if `minus`, -0. */
static bool is_zero(const struct node *node, bool minus)
{
    return node->operation == NODE_LITERAL && node->literal == 0 && (signbit(node->literal) != 0) == minus;
}

static bool is_finite(struct range r)
{
    return !r.nan && r.low > -INFINITY && r.high < INFINITY;
}

/* True if y + zero is y. */
static bool adds_nothing(const struct node *y, const struct node *zero, bool subtracted)
{
    return is_zero(zero, !subtracted) || (is_zero(zero, subtracted) && !y->range.negative_zero);
}

static bool is_zero_product(const struct node *y, const struct node *zero)
{
    return is_zero(zero, false) && is_finite(y->range) && y->range.low >= 0 && !y->range.negative_zero;
}

static bool replace_by_copy(struct node *node, int number, struct range range)
{
    *node = (struct node){.operation = NODE_COPY, .left = number, .range = range};
    return true;
}

static bool replace_by_zero(struct node *node)
{
    *node = (struct node){.operation = NODE_LITERAL};
    return true;
}

static bool reduce_multiply(struct node *node, const struct node *left, const struct node *right)
{
    if (is_one(right))
        return replace_by_copy(node, node->left, left->range);
    if (is_one(left))
        return replace_by_copy(node, node->right, right->range);
    return (is_zero_product(left, right) || is_zero_product(right, left)) && replace_by_zero(node);
}

static bool reduce_add(struct node *node, const struct node *left, const struct node *right)
{
    if (adds_nothing(left, right, false))
        return replace_by_copy(node, node->left, left->range);
    return adds_nothing(right, left, false) && replace_by_copy(node, node->right, right->range);
}

static bool reduce_subtract(struct node *node, const struct node *left, const struct node *right)
{
    if (node->left == node->right && is_finite(left->range))
        return replace_by_zero(node);
    return adds_nothing(left, right, true) && replace_by_copy(node, node->left, left->range);
}

static bool reduce_one(struct node *program, struct node *node)
{
    node->left = copied(program, node->left);
    node->right = copied(program, node->right);
    const struct node *left = program + node->left, *right = program + node->right;
    switch (node->operation) {
    case NODE_ADD:
        node->range = range_of_add(left->range, right->range);
        return reduce_add(node, left, right);
    case NODE_SUBTRACT:
        node->range = range_of_subtract(left->range, right->range);
        return reduce_subtract(node, left, right);
    case NODE_MULTIPLY:
        node->range = range_of_multiply(left->range, right->range);
        return reduce_multiply(node, left, right);
    default: return false;
    }
}

int reduce(struct node *program, int count)
{
    int replaced = 0;
    for (int i = 0; i < count; i++)
        if (program[i].operation != NODE_INPUT && program[i].operation != NODE_LITERAL)
            replaced += reduce_one(program, program + i);
    return replaced;
}
