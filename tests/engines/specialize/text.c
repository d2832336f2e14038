/* Code by way of text: the assembler makes the bytes of the direct encoder, for random keys, all shaders and
 * the routines of all streams, at every number of lanes. NASM assembles a sample of the texts to the same
 * instructions. Wrong texts are refused. encode.c tests every row of x86.def by way of text too. */
#include "engines/specialize/specialize.h"
#include "base/random.h"
#include "engines/specialize/build.h"
#include "tests/support/routine/routines.h"
#include "tests/support/system/seed.h"
#include <unity.h>

#include <Zydis/Zydis.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

static struct builder *builder, *other;
static unsigned visited;
static char message[KEY_TEXT_CAPACITY + 1000];

void setUp(void)
{
    struct error error = {{0}};
    builder = specialize_take(&error);
    other = specialize_take(&error);
    TEST_ASSERT_TRUE_MESSAGE(builder && other, error.text);
    visited = 0;
}

void tearDown(void)
{
    specialize_give(builder);
    specialize_give(other);
}

static struct build_options options_of(unsigned number)
{
    static const uint8_t widths[] = {1, 4, 8, 16};
    static const enum profile profiles[] = {PROFILE_FULL, PROFILE_THESIS, PROFILE_NONE};
    struct build_options options = {.width = widths[number % 4], .profile = profiles[number / 4 % 3]};
    options.parts = options.width < 16 && number % 5 == 0 ? 2 : 1;
    options.addresses = number % 3 ? ADDRESSES_LOADED : ADDRESSES_PATCHED;
    options.calls = number % 11 < 4 ? CALLS_SAMPLING : CALLS_INLINE;
    options.allocator = number % 7 == 0 ? ALLOCATOR_none : ALLOCATOR_scan;
    return options;
}

/* --- The bytes of the encoder --------------------------------------------------------------------------- */

static XXH64_hash_t direct_digest, text_digest;

static size_t build(struct builder *b, struct build_options options, enum encoding encoding, enum unit unit,
                    const union key *key)
{
    struct error error = {{0}};
    char text[KEY_TEXT_CAPACITY];
    options.encoding = encoding;
    size_t bytes = specialize_code(b, &options, unit, key, NULL, NULL, &error);
    if (!bytes && strstr(error.text, "too many pointers")) {
        options.addresses = ADDRESSES_LOADED;
        bytes = specialize_code(b, &options, unit, key, NULL, NULL, &error);
    }
    snprintf(message, sizeof message, "%u lanes, %s key %s: %s", options.width, unit_name[unit],
             key_print(unit, key, text), error.text);
    TEST_ASSERT_NOT_EQUAL_MESSAGE(0, bytes, message);
    return bytes;
}

static bool is_same(const void *a, const void *b, size_t bytes)
{
    return !memcmp(a, b, bytes);
}

/* Reports the operation where the bytes first differ. */
static void expect_same_code(const struct emitter *direct, const struct emitter *text, size_t bytes)
{
    size_t at = 0;
    while (at < bytes && direct->code[at] == text->code[at])
        at++;
    if (at == bytes)
        return;
    size_t line = 0;
    while (line + 1 < direct->lines && direct->line[line + 1].offset <= at)
        line++;
    snprintf(message + strlen(message), 100, "; operation %u, offset %zu", direct->line[line].instruction,
             at);
    TEST_FAIL_MESSAGE(message);
}

static void expect_same_unwinding(const struct emitter *direct, const struct emitter *text)
{
    TEST_ASSERT_EQUAL_MESSAGE(direct->unwinds, text->unwinds, message);
    for (uint32_t i = 0; i < direct->unwinds; i++)
        TEST_ASSERT_EQUAL_MESSAGE(direct->unwind[i].offset, text->unwind[i].offset, message);
}

static void expect_same_pointers(const struct emitter *direct, const struct emitter *text)
{
    TEST_ASSERT_EQUAL_MESSAGE(direct->pointers, text->pointers, message);
    for (uint32_t i = 0; i < direct->pointers; i++)
        TEST_ASSERT_EQUAL_MESSAGE(direct->pointer[i].offset, text->pointer[i].offset, message);
}

/* Also the positions of lines, of unwinding rules and of pointers. */
static void compare_routine(void *context, enum unit unit, const union key *key)
{
    const struct build_options options = options_of(visited++);
    const struct emitter *direct = &builder->emitter, *text = &other->emitter;
    (void)context;
    size_t bytes = build(builder, options, ENCODING_BYTES, unit, key);
    TEST_ASSERT_EQUAL_MESSAGE(bytes, build(other, options, ENCODING_TEXT, unit, key), message);
    expect_same_code(direct, text, bytes);
    TEST_ASSERT_EQUAL_MESSAGE(direct->code_bytes, text->code_bytes, message);
    TEST_ASSERT_EQUAL_MESSAGE(direct->lines, text->lines, message);
    expect_same_unwinding(direct, text);
    expect_same_pointers(direct, text);
    for (uint32_t i = 0; i < direct->lines; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(direct->line[i].offset, text->line[i].offset, message);
        TEST_ASSERT_EQUAL_MESSAGE(direct->line[i].instruction, text->line[i].instruction, message);
    }
    direct_digest = XXH3_64bits_withSeed(direct->code, bytes, direct_digest);
    text_digest = XXH3_64bits_withSeed(text->code, bytes, text_digest);
}

static void the_assembler_makes_the_bytes_of_the_encoder(void)
{
    direct_digest = text_digest = 0;
    visit_random_keys(test_share(300), test_seed(), compare_routine, NULL);
    visit_shaders(test_seed(), compare_routine, NULL);
    visit_random_shaders(test_share(150), test_seed(), compare_routine, NULL);
    visit_streams(compare_routine, NULL);
    TEST_ASSERT_GREATER_THAN(test_share(1000), visited);
    TEST_ASSERT_EQUAL_HEX64(direct_digest, text_digest);
}

/* --- NASM ----------------------------------------------------------------------------------------------- */

enum { SAMPLE = 41, INSTRUCTIONS = 1 << 16, ROOM = 4 << 20 };

/* The instructions of code without padding. */
struct listing {
    const uint8_t *code;
    size_t bytes, count;
    uint32_t at[INSTRUCTIONS];
};

static struct listing ours, theirs;
static uint8_t assembled[ROOM];
static unsigned identical, equivalent;

static ZydisDecoder decoder;

static void decode(const struct listing *l, size_t n, ZydisDecodedInstruction *i,
                   ZydisDecodedOperand *operands)
{
    TEST_ASSERT_TRUE(
        ZYAN_SUCCESS(ZydisDecoderDecodeFull(&decoder, l->code + l->at[n], l->bytes - l->at[n], i, operands)));
}

/* Lists the instructions before an address, or the first ones, at most `most`. Code follows the last return:
 * what is seldom executed, and subroutines. */
static void list(struct listing *l, size_t end, size_t most)
{
    ZydisDecodedInstruction i;
    ZydisDecodedOperand operands[ZYDIS_MAX_OPERAND_COUNT];
    l->count = 0;
    for (uint32_t at = 0; at < end && l->count < most; at += i.length) {
        TEST_ASSERT_LESS_THAN(INSTRUCTIONS, l->count);
        l->at[l->count] = at;
        decode(l, l->count, &i, operands);
        l->count += i.mnemonic != ZYDIS_MNEMONIC_NOP;
    }
}

/* Returns the number of the instruction at an address, or the negative distance of data from the end. */
static int64_t referent(const struct listing *l, uint64_t address)
{
    size_t low = 0, high = l->count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (l->at[middle] < address)
            low = middle + 1;
        else
            high = middle;
    }
    if (low < l->count)
        return (int64_t)low;
    return (int64_t)address - (int64_t)l->bytes - 1;
}

static bool same_operand(size_t n, const ZydisDecodedInstruction *i, const ZydisDecodedOperand *a,
                         const ZydisDecodedInstruction *j, const ZydisDecodedOperand *b)
{
    ZyanU64 x = 0, y = 0;
    bool relative = a->type == ZYDIS_OPERAND_TYPE_IMMEDIATE
                        ? a->imm.is_relative
                        : a->type == ZYDIS_OPERAND_TYPE_MEMORY && a->mem.base == ZYDIS_REGISTER_RIP;
    if (a->type != b->type || a->size != b->size)
        return false;
    if (relative) {
        ZydisCalcAbsoluteAddress(i, a, ours.at[n], &x);
        ZydisCalcAbsoluteAddress(j, b, theirs.at[n], &y);
        return referent(&ours, x) == referent(&theirs, y);
    }
    switch (a->type) {
    case ZYDIS_OPERAND_TYPE_REGISTER: return a->reg.value == b->reg.value;
    case ZYDIS_OPERAND_TYPE_IMMEDIATE: return a->imm.value.u == b->imm.value.u;
    default:
        return a->mem.base == b->mem.base && a->mem.index == b->mem.index && a->mem.scale == b->mem.scale &&
               a->mem.disp.value == b->mem.disp.value;
    }
}

static bool same_instruction(size_t n)
{
    ZydisDecodedInstruction i, j;
    ZydisDecodedOperand a[ZYDIS_MAX_OPERAND_COUNT], b[ZYDIS_MAX_OPERAND_COUNT];
    decode(&ours, n, &i, a);
    decode(&theirs, n, &j, b);
    bool same = i.mnemonic == j.mnemonic && i.operand_count_visible == j.operand_count_visible &&
                i.avx.mask.mode == j.avx.mask.mode && i.avx.mask.reg == j.avx.mask.reg &&
                i.avx.broadcast.mode == j.avx.broadcast.mode;
    for (unsigned o = 0; same && o < i.operand_count_visible; o++)
        same = same_operand(n, &i, &a[o], &j, &b[o]);
    return same;
}

static void run_nasm(const char *folder, const struct encode_text *text)
{
    char path[200], command[600];
    snprintf(path, sizeof path, "%s/routine.asm", folder);
    FILE *file = fopen(path, "w");
    TEST_ASSERT_NOT_NULL(file);
    fwrite(text->start, 1, (size_t)(text->at - text->start), file);
    TEST_ASSERT_EQUAL(0, fclose(file));
    snprintf(command, sizeof command, "nasm -f bin -o %s/routine.bin %s 2>&1", folder, path);
    TEST_ASSERT_EQUAL_MESSAGE(0, system(command), message);
    snprintf(path, sizeof path, "%s/routine.bin", folder);
    file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL(file);
    theirs.code = assembled;
    theirs.bytes = fread(assembled, 1, ROOM, file);
    fclose(file);
}

/* NASM has other padding, and for some instructions another encoding: mov and test of general registers, and
 * vmovaps from a register above 7, for which it has no syntax for the shorter one. Then the instructions must
 * be the same. */
static void assemble_with_nasm(void *folder, enum unit unit, const union key *key)
{
    if (visited++ % SAMPLE)
        return;
    const struct build_options options = options_of(visited / SAMPLE);
    ours.bytes = build(builder, options, ENCODING_TEXT, unit, key);
    ours.code = builder->emitter.code;
    run_nasm(folder, &builder->emitter.text);
    if (ours.bytes == theirs.bytes && is_same(ours.code, theirs.code, ours.bytes)) {
        identical++;
        return;
    }
    list(&ours, builder->emitter.code_bytes, INSTRUCTIONS);
    list(&theirs, theirs.bytes, ours.count);
    TEST_ASSERT_EQUAL_MESSAGE(ours.count, theirs.count, message);
    for (size_t n = 0; n < ours.count; n++)
        if (!same_instruction(n)) {
            snprintf(message + strlen(message), 60, " instruction %zu differs", n);
            TEST_FAIL_MESSAGE(message);
        }
    size_t data = ours.bytes - ((builder->emitter.code_bytes + 63) & ~(size_t)63);
    TEST_ASSERT_GREATER_OR_EQUAL(data, theirs.bytes);
    TEST_ASSERT_TRUE_MESSAGE(is_same(ours.code + ours.bytes - data, theirs.code + theirs.bytes - data, data),
                             message);
    equivalent++;
}

static void nasm_assembles_the_texts_to_the_same_instructions(void)
{
    char folder[] = "/tmp/triptych-text-XXXXXX", path[200];
    identical = equivalent = 0;
    if (system("nasm -v >/dev/null 2>&1"))
        TEST_IGNORE_MESSAGE("needs nasm");
    ZydisDecoderInit(&decoder, ZYDIS_MACHINE_MODE_LONG_64, ZYDIS_STACK_WIDTH_64);
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    visit_random_keys(test_share(600), test_seed(), assemble_with_nasm, folder);
    visit_shaders(test_seed(), assemble_with_nasm, folder);
    visit_streams(assemble_with_nasm, folder);
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/routine.%s", folder, i ? "asm" : "bin");
        unlink(path);
    }
    rmdir(folder);
    printf("%u routines have the same bytes, %u the same instructions\n", identical, equivalent);
    TEST_ASSERT_GREATER_THAN(10, identical + equivalent);
}

/* --- Wrong texts ---------------------------------------------------------------------------------------- */

static struct encoder encoder;
static uint8_t code[256];
static int32_t labels[4];
static struct fixup fixups[8];

static int assemble(const char *text, struct error *error)
{
    static struct mnemonics mnemonics;
    struct assembler assembler = {.start = text,
                                  .at = text,
                                  .end = text + strlen(text),
                                  .encoder = &encoder,
                                  .mnemonics = &mnemonics,
                                  .error = error};
    encode_start(&encoder, code, sizeof code, labels, 4, fixups, 8);
    while (assembler.at < assembler.end)
        if (encode_assemble_line(&assembler))
            return -1;
    return encode_finish(&encoder, error);
}

static void wrong_texts_are_refused(void)
{
    static const char *const rows[][2] = {
        {"vaddps ymm1, ymm2, ymm3\nvadps ymm1, ymm2, ymm3",
         "line 2: found \"vadps\", expected an instruction"},
        {"vaddps ymm1, ymm2", "line 1: found \"vaddps\", expected operands that it has"},
        {"vaddps ymm1, ymm2, xmm3", "operands that it has"},
        {"vaddps ymm1, ymm2, dword [rax]", "operands that it has"},
        {"vaddps ymm1, ymm2, ymm3{k1}", "operands that it has"},
        {"vaddps ymm1{z}, ymm2, ymm3", "operands that it has"},
        {"vaddps ymm1, ymm2, [rax+ymm3*4]", "operands that it has"},
        {"vpand zmm1, zmm2, zmm3", "operands that it has"},
        {"vshufps ymm1, ymm2, ymm3, 256", "operands that it has"},
        {"vgatherdps ymm1, [rax+ymm1*4], ymm2", "operands that it has"},
        {"vgatherdps ymm1, [rax+rcx*4], ymm2", "operands that it has"},
        {"add rax, ecx", "operands that it has"},
        {"add eax, 0x123456789", "operands that it has"},
        {"shl eax, 64", "operands that it has"},
        {"lea rax, rcx", "operands that it has"},
        {"vaddps ymm32, ymm2, ymm3", "found \"ymm32\", expected an operand"},
        {"vaddps ymm1, ymm2, ymm3,", "found the end of the line, expected an operand"},
        {"vaddps ymm1, ymm2, ymm3 ymm4", "found \"ymm4\", expected the end of the line"},
        {"vblendvps ymm1, ymm2, ymm3, ymm4, ymm5", "expected at most four operands"},
        {"mov rax, 99999999999999999999", "expected the end of a number of at most 64 bits"},
        {"mov rax, [rax+rcx*3]", "expected one index register times 1, 2, 4 or 8"},
        {"mov rax, [rax+rsp*1]", "expected one index register"},
        {"mov rax, [rax+rcx+rdx]", "found \"rcx\", expected one base register"},
        {"mov rax, [rel L1+rcx*1]", "expected an address relative to a label without a register"},
        {"mov rax, [eax]", "found \"eax\", expected a register of an address"},
        {"mov rax, [rax", "expected +, - or ]"},
        {"vaddps zmm1{k8}, zmm2, zmm3", "found \"k8\", expected 1toN, k1 to k7, or z"},
        {"vaddps zmm1{k1, zmm2, zmm3", "expected }"},
        {"jmp near L4", "found \"L4\", expected a label"},
        {"jz here", "found \"here\", expected a label"},
        {"L1: jz near L1", "found \"L1\", expected a label after a near jump"},
        {"L1:\nL1:", "line 2: found \"L1\", expected a label that is not bound yet"},
        {"jz near L1", "machine code refers to label 1, which is bound nowhere"},
        {"align 3", "found an alignment of 3, expected a power of two"},
        {"bits 32", "expected 64 bits"},
        {"dd 1,", "found the end of the line, expected a number"},
        {"?", "found \"?\", expected the end of the line"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct error error = {{0}};
        TEST_ASSERT_EQUAL_MESSAGE(-1, assemble(rows[i][0], &error), rows[i][0]);
        if (!strstr(error.text, rows[i][1]))
            TEST_ASSERT_EQUAL_STRING(rows[i][1], error.text);
    }
}

static void comments_and_empty_lines_are_skipped(void)
{
    struct error error = {{0}};
    TEST_ASSERT_EQUAL_MESSAGE(0, assemble("\n ; nothing\n\tret ; the end", &error), error.text);
    TEST_ASSERT_EQUAL_HEX8(0xC3, code[0]);
    TEST_ASSERT_EQUAL(1, encode_size(&encoder));
}

/* Random changes of a valid text are read or refused. */
static void damaged_texts_are_read_or_refused(void)
{
    static const char text[] = "L0: vfmadd231ps zmm1{k2}{z}, zmm3, dword [rel L1+64]{1to16}\nmov eax, 0x10\n"
                               "vgatherdps ymm1, [rax+ymm2*4-8], ymm3\njnz L0\nL1: dd 0x3f800000, 1\n";
    static const char letters[] = "Lrxyzmk0123456789abcdef[]{}+-*,:; \n";
    char damaged[sizeof text];
    struct random source = random_start(test_seed(), 0);
    for (unsigned n = 0; n < 200000; n++) {
        struct error error = {{0}};
        memcpy(damaged, text, sizeof text);
        for (unsigned change = 0; change < 1 + n % 3; change++) {
            uint32_t place = random_below(&source, sizeof text - 1);
            damaged[place] = letters[random_below(&source, sizeof letters - 1)];
        }
        int refused = assemble(damaged, &error);
        TEST_ASSERT_EQUAL(refused != 0, error.text[0] != 0);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_assembler_makes_the_bytes_of_the_encoder);
    RUN_TEST(nasm_assembles_the_texts_to_the_same_instructions);
    RUN_TEST(wrong_texts_are_refused);
    RUN_TEST(comments_and_empty_lines_are_skipped);
    RUN_TEST(damaged_texts_are_read_or_refused);
    return UNITY_END();
}
