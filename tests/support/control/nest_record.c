#include "ir/bind.h"

#include "nest_text.h"

void nest_record(const struct nest *nest, struct ir *ir)
{
    struct env e = {.ir = ir};
    ir_start(ir);
    nest_text(&e, nest);
}
