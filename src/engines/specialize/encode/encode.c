#include "engines/specialize/encode/encode_bytes.h"
#include "engines/specialize/encode/operand.h"

/* Addresses, control flow, data and padding. */

void encode_fail(struct encoder *encoder, enum encoder_failure failure)
{
    if (!encoder->failure)
        encoder->failure = failure;
    encoder->limit = encoder->start;
}

void encode_relative(struct encoder *encoder, uint8_t *at, uint32_t label, int32_t displacement, int trailing)
{
    assert(label < encoder->label_count);
    int32_t addend = displacement - 4 - trailing;
    int32_t offset = (int32_t)(at - encoder->start);
    if (encoder->labels[label] != LABEL_UNBOUND) {
        encode_store32(at, (uint32_t)(encoder->labels[label] + addend - offset));
    } else if (encoder->fixup_count < encoder->fixup_capacity) {
        encoder->fixups[encoder->fixup_count++] = (struct fixup){(uint32_t)offset, label, addend};
    } else {
        encode_fail(encoder, ENCODER_OUT_OF_FIXUPS);
    }
}

static void branch(struct encoder *encoder, unsigned short_opcode, uint32_t label)
{
    assert(label < encoder->label_count);
    if (!encode_room(encoder, ENCODER_SLACK))
        return;
    uint8_t *at = encoder->at;
    int32_t target = encoder->labels[label];
    ptrdiff_t distance = target - (at + 2 - encoder->start);
    if (target != LABEL_UNBOUND && distance >= INT8_MIN) {
        at[0] = (uint8_t)short_opcode;
        at[1] = (uint8_t)distance;
        encoder->at = at + 2;
        return;
    }
    bool conditional = short_opcode != 0xEB;
    *at = 0x0F;
    at += conditional;
    *at++ = (uint8_t)(conditional ? short_opcode + 0x10 : 0xE9);
    encode_relative(encoder, at, label, 0, 0);
    encoder->at = at + 4;
}

static const char *const conditions[] = {
#define X86_CONDITION(name, code) [code] = #name,
#include "def/engine/x86.def"
};

void encode_jump(struct encoder *encoder, uint32_t label)
{
    if (encoder->text) {
        encode_print_jump(encoder, "mp", label);
        return;
    }
    branch(encoder, 0xEB, label);
}

void encode_jump_if(struct encoder *encoder, enum x86_condition condition, uint32_t label)
{
    if (encoder->text) {
        encode_print_jump(encoder, conditions[condition], label);
        return;
    }
    branch(encoder, 0x70 | (unsigned)condition, label);
}

void encode_call(struct encoder *encoder, uint32_t label)
{
    assert(label < encoder->label_count);
    if (encoder->text) {
        encode_print_call(encoder, label);
        return;
    }
    if (!encode_room(encoder, ENCODER_SLACK))
        return;
    *encoder->at = 0xE8;
    encode_relative(encoder, encoder->at + 1, label, 0, 0);
    encoder->at += 5;
}

void encode_return(struct encoder *encoder)
{
    if (encoder->text) {
        encode_print_directive(encoder, "ret", 0);
        return;
    }
    encode_data(encoder, &(uint8_t){0xC3}, 1);
}

void encode_label(struct encoder *encoder, uint32_t label)
{
    assert(label < encoder->label_count && encoder->labels[label] == LABEL_UNBOUND);
    encoder->labels[label] = (int32_t)encode_size(encoder);
    if (encoder->text)
        encode_print_label(encoder, label);
}

void encode_data(struct encoder *encoder, const void *bytes, size_t count)
{
    if (encoder->text) {
        encode_print_words(encoder, bytes, count);
        return;
    }
    if (!encode_room(encoder, count))
        return;
    memcpy(encoder->at, bytes, count);
    encoder->at += count;
}

void encode_nops(struct encoder *encoder, unsigned count)
{
    /* The forms that Intel recommends. Row n - 1 is one instruction of n bytes. */
    enum { LONGEST = 9 };
    static const uint8_t nops[LONGEST][LONGEST] = {
        {0x90},
        {0x66, 0x90},
        {0x0F, 0x1F, 0x00},
        {0x0F, 0x1F, 0x40, 0x00},
        {0x0F, 0x1F, 0x44, 0x00, 0x00},
        {0x66, 0x0F, 0x1F, 0x44, 0x00, 0x00},
        {0x0F, 0x1F, 0x80, 0x00, 0x00, 0x00, 0x00},
        {0x0F, 0x1F, 0x84, 0x00, 0x00, 0x00, 0x00, 0x00},
        {0x66, 0x0F, 0x1F, 0x84, 0x00, 0x00, 0x00, 0x00, 0x00},
    };
    while (count) {
        unsigned length = count < LONGEST ? count : LONGEST;
        encode_data(encoder, nops[length - 1], length);
        count -= length;
    }
}

void encode_align(struct encoder *encoder, unsigned alignment)
{
    assert(alignment && !(alignment & (alignment - 1)));
    if (encoder->text) {
        encode_print_directive(encoder, "align", alignment);
        return;
    }
    encode_nops(encoder, (unsigned)-encode_size(encoder) & (alignment - 1));
}

void encode_start(struct encoder *encoder, void *code, size_t bytes, int32_t *labels, uint32_t label_count,
                  struct fixup *fixups, uint32_t fixup_capacity)
{
    assert(bytes <= INT32_MAX);
    *encoder = (struct encoder){
        .start = code,
        .at = code,
        .limit = (uint8_t *)code + bytes,
        .labels = labels,
        .fixups = fixups,
        .label_count = label_count,
        .fixup_capacity = fixup_capacity,
    };
    for (uint32_t label = 0; label < label_count; label++)
        labels[label] = LABEL_UNBOUND;
}

uint32_t encode_add_label(struct encoder *encoder)
{
    encoder->labels[encoder->label_count] = LABEL_UNBOUND;
    return encoder->label_count++;
}

int encode_finish(struct encoder *encoder, struct error *error)
{
    if (encoder->failure == ENCODER_OUT_OF_CODE)
        return error_set(error, "machine code does not fit: no room after %zu bytes", encode_size(encoder));
    if (encoder->failure == ENCODER_OUT_OF_TEXT)
        return error_set(error, "assembly text does not fit: no room after %zu characters",
                         encode_size(encoder));
    if (encoder->failure == ENCODER_OUT_OF_FIXUPS)
        return error_set(error, "machine code has more than %u forward references", encoder->fixup_capacity);
    for (uint32_t i = 0; i < encoder->fixup_count; i++) {
        struct fixup fixup = encoder->fixups[i];
        int32_t target = encoder->labels[fixup.label];
        if (target == LABEL_UNBOUND) {
            encode_fail(encoder, ENCODER_UNBOUND_LABEL);
            return error_set(error, "machine code refers to label %u, which is bound nowhere", fixup.label);
        }
        encode_store32(encoder->start + fixup.offset,
                       (uint32_t)(target + fixup.addend - (int32_t)fixup.offset));
    }
    return 0;
}
