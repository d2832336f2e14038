/* Code by way of text: it is printed as assembly (encode/print.c), and the assembler reads it
 * (encode/assemble.c). The first SoftWire generated code in this way. */
#include "base/slab.h"
#include "engines/specialize/emit/emit.h"

enum { TEXT_CAPACITY = 32 << 20 /* characters; pages that a text does not reach are never touched */ };

static struct slab texts = SLAB(TEXT_CAPACITY);
SLAB_CLEAR_AT_UNLOAD(texts)

int emit_take_text(struct emitter *m, struct error *error)
{
    if (m->text.start)
        return 0;
    m->text.start = slab_take(&texts);
    m->text.limit = m->text.start + TEXT_CAPACITY;
    if (m->text.start)
        return 0;
    return error_set(error, "out of memory for the text of a routine (%d bytes)", TEXT_CAPACITY);
}

void emit_give_text(struct emitter *m)
{
    if (m->text.start)
        slab_give(&texts, m->text.start);
    m->text = (struct encode_text){0};
}

void emit_start_text(struct emitter *m)
{
    m->text.at = m->text.start;
    m->encoder.text = &m->text;
    encode_print_directive(&m->encoder, "bits", 64);
}

/* The next entries of the emitter's tables of positions. */
struct cursor {
    uint32_t line, unwind, pointer;
    bool code_bytes;
};

/* Replaces the positions up to here in the text by that of the code. */
static void place(struct emitter *m, struct cursor *c, uint32_t text, uint32_t code)
{
    for (; c->line < m->lines && m->line[c->line].offset <= text; c->line++)
        m->line[c->line].offset = code;
    for (; c->unwind < m->unwinds && m->unwind[c->unwind].offset <= text; c->unwind++)
        m->unwind[c->unwind].offset = code;
    for (const uint32_t bytes = sizeof(uint64_t);
         c->pointer < m->pointers && m->pointer[c->pointer].offset + bytes <= text; c->pointer++)
        m->pointer[c->pointer].offset = code - bytes; /* at the end of its instruction */
    if (!c->code_bytes && m->code_bytes <= text) {
        m->code_bytes = code;
        c->code_bytes = true;
    }
}

int emit_assemble(struct emitter *m, struct error *error)
{
    struct assembler as = {.start = m->text.start,
                           .at = m->text.start,
                           .end = m->text.at,
                           .encoder = &m->encoder,
                           .mnemonics = &m->mnemonics,
                           .error = error};
    struct cursor cursor = {0};
    encode_start(&m->encoder, m->code, sizeof m->code, m->labels, m->encoder.label_count, m->fixups,
                 FIXUP_CAPACITY);
    while (as.at < as.end && !m->encoder.failure) {
        place(m, &cursor, (uint32_t)(as.at - as.start), (uint32_t)encode_size(&m->encoder));
        if (encode_assemble_line(&as))
            return -1;
    }
    return 0;
}
