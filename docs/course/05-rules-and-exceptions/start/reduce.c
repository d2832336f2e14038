#include "rules.h"

int reduce(struct node *program, int count)
{
    (void)program;
    (void)count;
    return 0;
}
