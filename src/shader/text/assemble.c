/* The assembler: a statement per line.
 *
 *   text         version { statement }
 *   version      vs_2_0 | vs.2.0 | ...                           a row of def/shader/shader_model.def
 *   statement    [ ( [!] p0 [.component] ) ] [ + ] word [ operand { , operand } ]
 *   word         name [ _comparison ] { _modifier }              a row of def/shader/shader.def
 *              | dcl [ _usage[number] | _kind ] { _modifier }
 *
 * The row determines the operands (operand.c). Letters may be small or large everywhere. */
#include "shader/text/assemble.h"

#include <ctype.h>
#include <string.h>

/* --- Version ------------------------------------------------------------------------------------------- */

/* "vs_1_1" is one word; "vs.1.1" is a word, a point and a number (1.1), "vs.2.x" two words more. */
static int read_version(struct assembler *assembler)
{
    struct scanner *scanner = &assembler->scanner;
    struct scan_token place = scanner->token;
    const char *end = place.text + place.length;
    while (end < scanner->end && (isalnum((unsigned char)*end) || *end == '.' || *end == '_'))
        end++;
    char name[8] = "";
    if (place.type == SCAN_WORD && (size_t)(end - place.text) < sizeof name)
        for (size_t i = 0; place.text + i < end; i++)
            name[i] = place.text[i] == '.' ? '_' : place.text[i];
    for (unsigned i = 0; i < MODEL_COUNT; i++)
        if (scan_piece_is((struct scan_piece){name, strlen(name)}, shader_models[i].name))
            assembler->shader->model = &shader_models[i];
    if (!assembler->shader->model)
        return scan_expected_word(scanner, WORDS_OF_ROWS(shader_models),
                                  (struct scan_piece){place.text, (size_t)(end - place.text)},
                                  "a version, vs_1_1 to vs_3_0 or ps_1_1 to ps_3_0");
    while (scanner->token.text < end)
        if (scan_next(scanner))
            return -1;
    return 0;
}

/* --- The word ------------------------------------------------------------------------------------------ */

/* The row with that name in the model; `comparison` selects one of two. SHADER_COUNT if there is none;
 * `elsewhere` then shows if other models have one. */
static enum shader_opcode find_operation(struct scan_piece name, bool comparison,
                                         const struct shader_model *model, bool *elsewhere)
{
    *elsewhere = false;
    for (unsigned i = 0; i < SHADER_COUNT; i++) {
        const struct shader_operation *row = &shader_operations[i];
        if (!scan_piece_is(name, row->name) || (row->control == COMPARISON) != comparison)
            continue;
        if (shader_slots(row, model) >= 0)
            return i;
        *elsewhere = true;
    }
    return SHADER_COUNT;
}

/* The instructions of a model. */
static const char *operation_choice(const struct words *words, unsigned index)
{
    return index >= SHADER_COUNT                                       ? NULL
           : shader_slots(&shader_operations[index], words->list) >= 0 ? shader_operations[index].name
                                                                       : "";
}

/* The number of the word that the piece begins with; -1 if none. The word must be followed by digits only. */
static int find_word(const struct shader_word *words, struct scan_piece piece, struct scan_piece *digits)
{
    int found = -1;
    for (; words->name; words++) {
        size_t length = strlen(words->name);
        size_t tail = piece.length;
        while (tail > 0 && isdigit((unsigned char)piece.text[tail - 1]))
            tail--;
        if (tail == length && scan_piece_is((struct scan_piece){piece.text, length}, words->name)) {
            *digits = (struct scan_piece){piece.text + length, piece.length - length};
            found = words->number;
        }
    }
    return found;
}

static int bad_piece(struct assembler *assembler, struct scan_piece piece, const char *expected)
{
    const struct scan_token *token = &assembler->scanner.token;
    return scan_fail(&assembler->scanner, token, (size_t)(piece.text - token->text),
                     "found '_%.*s', expected %s", (int)piece.length, piece.text, expected);
}

/* _usage, _usage5 or _kind after dcl. */
static int read_declaration(struct assembler *assembler, struct scan_piece *rest,
                            struct shader_instruction *instruction)
{
    struct scan_piece digits = {NULL, 0}, before = *rest, piece = scan_piece_next(rest);
    int kind = find_word(shader_kinds, piece, &digits);
    if (kind >= 0 && !digits.length) {
        instruction->kind = (uint8_t)kind;
        return 0;
    }
    int usage = find_word(shader_usages, piece, &digits);
    if (usage < 0) {
        *rest = before; /* perhaps a modifier */
        return 0;
    }
    unsigned index = 0;
    for (size_t i = 0; i < digits.length && index < 100; i++)
        index = index * 10 + (unsigned)(digits.text[i] - '0');
    if (index > 15)
        return bad_piece(assembler, piece, "a usage's number from 0 to 15");
    instruction->usage = (uint8_t)usage;
    instruction->usage_index = (uint8_t)index;
    return 0;
}

static const struct result_modifier {
    const char *name;
    uint8_t modifier;
    int8_t shift;
} result_modifiers[] = {
    {"sat", RESULT_SATURATE, 0},
    {"pp", RESULT_PARTIAL, 0},
    {"centroid", RESULT_CENTROID, 0},
    {"x2", 0, 1},
    {"x4", 0, 2},
    {"x8", 0, 3},
    {"d2", 0, -1},
    {"d4", 0, -2},
    {"d8", 0, -3},
};

enum { RESULT_MODIFIERS = sizeof result_modifiers / sizeof *result_modifiers };

/* Words that may follow dcl: modifiers, then kinds, then usages. */
static const char *declaration_choice(const struct words *words, unsigned index)
{
    (void)words;
    if (index < RESULT_MODIFIERS)
        return result_modifiers[index].name;
    index -= RESULT_MODIFIERS;
    for (const struct shader_word *kind = shader_kinds; kind->name; kind++, index--)
        if (!index)
            return kind->name;
    for (const struct shader_word *usage = shader_usages; usage->name; usage++, index--)
        if (!index)
            return usage->name;
    return NULL;
}

static int unknown_modifier(struct assembler *assembler, struct scan_piece piece, enum shader_opcode opcode)
{
    struct words words =
        opcode == SHADER_DCL ? (struct words){.at = declaration_choice} : WORDS_OF_ROWS(result_modifiers);
    bad_piece(assembler, piece, "a modifier, like _sat");
    return words_suggest_in(words, piece.text, piece.length, assembler->scanner.error);
}

static int read_results(struct assembler *assembler, struct scan_piece rest, enum shader_opcode opcode,
                        struct shader_operand *result)
{
    while (rest.length) {
        struct scan_piece piece = scan_piece_next(&rest);
        const struct result_modifier *row = result_modifiers;
        while (row < result_modifiers + RESULT_MODIFIERS && !scan_piece_is(piece, row->name))
            row++;
        if (row == result_modifiers + RESULT_MODIFIERS)
            return unknown_modifier(assembler, piece, opcode);
        if ((row->modifier & result->modifier) || (row->shift && result->shift))
            return bad_piece(assembler, piece, "each modifier once");
        result->modifier |= row->modifier;
        result->shift += row->shift;
    }
    return 0;
}

/* The instruction's word. Its result modifiers are kept in `result` until the destination is read. */
static int read_word(struct assembler *assembler, struct shader_instruction *instruction,
                     struct shader_operand *result)
{
    struct scanner *scanner = &assembler->scanner;
    const struct shader_model *model = assembler->shader->model;
    if (scanner->token.type != SCAN_WORD)
        return scan_expected(scanner, "an instruction");
    struct scan_piece rest = {scanner->token.text, scanner->token.length};
    struct scan_piece name = scan_piece_next(&rest), after = rest, piece = scan_piece_next(&after);
    for (unsigned i = 0; shader_comparisons[i].name; i++)
        if (scan_piece_is(piece, shader_comparisons[i].name))
            instruction->comparison = shader_comparisons[i].number;
    bool elsewhere;
    enum shader_opcode opcode = find_operation(name, instruction->comparison, model, &elsewhere);
    if (opcode == SHADER_COUNT && elsewhere)
        return scan_fail(scanner, &scanner->token, 0, "found '%.*s', which %s does not have",
                         (int)scanner->token.length, scanner->token.text, model->name);
    if (opcode == SHADER_COUNT)
        return scan_expected_word(scanner, (struct words){.at = operation_choice, .list = model}, name,
                                  "an instruction of %s", model->name);
    instruction->opcode = (uint8_t)opcode;
    if (instruction->comparison)
        rest = after;
    if (opcode == SHADER_DCL && read_declaration(assembler, &rest, instruction))
        return -1;
    if (rest.length && !shader_operations[opcode].destination)
        return bad_piece(assembler, rest, "no modifier: nothing is written");
    return read_results(assembler, rest, opcode, result) ? -1 : scan_next(scanner);
}

/* --- The rest of a statement --------------------------------------------------------------------------- */

static int read_predicate(struct assembler *assembler, struct shader_instruction *instruction)
{
    struct scanner *scanner = &assembler->scanner;
    if (scan_sign(scanner, '('))
        return -1;
    struct scan_token place = scanner->token;
    if (assemble_source(assembler, &instruction->predicate))
        return -1;
    if (instruction->predicate.file != FILE_PREDICATE)
        return scan_fail(scanner, &place, 0, "found another register, expected p0 between the brackets");
    return scan_sign(scanner, ')');
}

static int read_boolean(struct assembler *assembler, uint32_t *literal)
{
    struct scanner *scanner = &assembler->scanner;
    struct scan_piece word = {scanner->token.text, scanner->token.length};
    if (scanner->token.type != SCAN_WORD || (!scan_piece_is(word, "true") && !scan_piece_is(word, "false")))
        return scan_expected(scanner, "true or false");
    *literal = scan_piece_is(word, "true");
    return scan_next(scanner);
}

static int read_integer(struct assembler *assembler, uint32_t *literal)
{
    struct scanner *scanner = &assembler->scanner;
    bool negative = scan_skip(scanner, '-');
    uint32_t whole;
    if (scan_whole(scanner, "a whole number", (uint32_t)INT32_MAX + negative, &whole))
        return -1;
    *literal = negative ? -whole : whole;
    return 0;
}

static int read_float(struct assembler *assembler, uint32_t *literal)
{
    struct scanner *scanner = &assembler->scanner;
    bool negative = scan_skip(scanner, '-');
    if (scan_number(scanner, "a number", literal))
        return -1;
    *literal ^= (uint32_t)negative << 31;
    return 0;
}

/* The literals after the destination of def, defi and defb. */
static int read_literals(struct assembler *assembler, struct shader_instruction *instruction)
{
    unsigned kind = shader_operations[instruction->opcode].destination;
    int (*read)(struct assembler *, uint32_t *) = kind == OPERAND_CONSTANT_BOOLEAN   ? read_boolean
                                                  : kind == OPERAND_CONSTANT_INTEGER ? read_integer
                                                                                     : read_float;
    for (unsigned i = 0; i < (kind == OPERAND_CONSTANT_BOOLEAN ? 1 : 4); i++)
        if (scan_sign(&assembler->scanner, ',') || read(assembler, &instruction->literal[i]))
            return -1;
    return 0;
}

static bool has_literals(const struct shader_operation *row)
{
    return row->destination >= OPERAND_CONSTANT && row->destination <= OPERAND_CONSTANT_BOOLEAN;
}

static int read_operands(struct assembler *assembler, struct shader_instruction *instruction,
                         const struct shader_operand *result)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    if (row->destination) {
        if (assemble_destination(assembler, &instruction->destination))
            return -1;
        instruction->destination.modifier = result->modifier;
        instruction->destination.shift = result->shift;
    }
    if (has_literals(row))
        return read_literals(assembler, instruction);
    for (unsigned i = 0; i < SHADER_SOURCES && row->source[i]; i++)
        if (((i || row->destination) && scan_sign(&assembler->scanner, ',')) ||
            assemble_source(assembler, &instruction->source[i]))
            return -1;
    return 0;
}

/* A sampler is declared with a kind of texture, an element or a varying with a usage, others with neither. */
static int check_declaration(struct assembler *assembler, const struct shader_instruction *instruction)
{
    const struct shader_operand *declared = &instruction->destination;
    bool sampler = declared->file == FILE_SAMPLER, kind = instruction->kind;
    if (sampler && !kind)
        return shader_fail(assembler->shader, instruction, declared, assembler->scanner.error,
                           "found a sampler, expected dcl_2d, dcl_cube or dcl_volume before it");
    if ((instruction->usage || instruction->usage_index) &&
        !shader_has_usage(declared->file, assembler->shader->model))
        return shader_fail(assembler->shader, instruction, declared, assembler->scanner.error,
                           "found %s%u after a usage, expected only dcl before it",
                           shader_registers[declared->file].name, declared->index);
    if (!sampler && kind)
        return shader_fail(assembler->shader, instruction, declared, assembler->scanner.error,
                           "found %s%u after a kind of texture, expected a sampler",
                           shader_registers[declared->file].name, declared->index);
    return 0;
}

/* the bytecode of other models has no bit for it */
static int read_pairing(struct assembler *assembler, struct shader_instruction *instruction)
{
    const struct shader_model *model = assembler->shader->model;
    if (scan_is(&assembler->scanner, '+') && (model->stage == STAGE_VERTEX || shader_major(model) >= 2))
        return scan_expected(&assembler->scanner, "an instruction, which is not paired in %s", model->name);
    instruction->coissue = scan_skip(&assembler->scanner, '+');
    return 0;
}

static int read_statement(struct assembler *assembler)
{
    struct scanner *scanner = &assembler->scanner;
    struct shader_operand result = {0};
    struct shader_instruction *instruction = shader_append(assembler->shader, scanner->error);
    if (!instruction)
        return -1;
    instruction->place = scanner->token.line;
    instruction->column = (uint16_t)(scanner->token.column < 0xffff ? scanner->token.column : 0xffff);
    if (scan_is(scanner, '(') && read_predicate(assembler, instruction))
        return -1;
    if (read_pairing(assembler, instruction) || read_word(assembler, instruction, &result) ||
        read_operands(assembler, instruction, &result))
        return -1;
    if (instruction->opcode == SHADER_DCL && check_declaration(assembler, instruction))
        return -1;
    if (scanner->token.type != SCAN_LINE_END && scanner->token.type != SCAN_END)
        return scan_expected(scanner, "the end of the line");
    return 0;
}

static int skip_lines(struct scanner *scanner)
{
    while (scanner->token.type == SCAN_LINE_END)
        if (scan_next(scanner))
            return -1;
    return 0;
}

static int read_text(struct assembler *assembler, const char *text, size_t bytes, struct error *error)
{
    struct scanner *scanner = &assembler->scanner;
    if (scan_start(scanner, assembler->shader->path, text, bytes, error) || skip_lines(scanner) ||
        read_version(assembler))
        return -1;
    if (scanner->token.type != SCAN_LINE_END && scanner->token.type != SCAN_END)
        return scan_expected(scanner, "the end of the line");
    for (;;) {
        if (skip_lines(scanner))
            return -1;
        if (scanner->token.type == SCAN_END)
            return 0;
        if (read_statement(assembler))
            return -1;
    }
}

int shader_assemble(const char *path, const char *text, size_t bytes, struct shader **shader,
                    struct error *error)
{
    *shader = NULL;
    struct assembler assembler = {.shader = shader_create(path, false, error)};
    if (!assembler.shader)
        return -1;
    if (bytes > SHADER_BYTES) {
        error_set(error, "%s: %zu bytes, expected at most %d", path, bytes, SHADER_BYTES);
    } else if (!read_text(&assembler, text, bytes, error)) {
        *shader = assembler.shader;
        return 0;
    }
    shader_free(assembler.shader);
    return -1;
}
