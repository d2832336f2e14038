/* Operands of the assembler: [! | - | 1-] register [[index]] [_modifier] [.components]
 *
 * A register is a row of def/shader/shader_register.def that the model has: the row's name, with a number if
 * the row is numbered. Brackets contain numbers and at most one of a0.x to a0.w and aL, with + between them;
 * the numbers are added to the register's. The register's number may be left out before brackets: c[a0.x + 5]
 * is c5[a0.x]. */
#include "shader/text/assemble.h"
#include "shader/code/token.h"

#include <ctype.h>
#include <string.h>

static uint32_t number_limit(unsigned file)
{
    return (file == FILE_CONSTANT ? TOKEN_CONSTANTS : TOKEN_REGISTERS) - 1;
}

/* --- Registers ----------------------------------------------------------------------------------------- */

/* The number after the piece's letters: digits only; or nothing, which sets `none`. */
static bool read_digits(struct scan_piece digits, uint32_t *value, bool *none)
{
    *value = 0;
    *none = !digits.length;
    for (size_t i = 0; i < digits.length; i++) {
        if (!isdigit((unsigned char)digits.text[i]) || i == 6)
            return false;
        *value = *value * 10 + (uint32_t)(digits.text[i] - '0');
    }
    return true;
}

/* The row whose register the piece names, preferably one of the model; FILE_NONE if no model has it. */
static enum shader_file find_register(struct scan_piece piece, const struct shader_model *model,
                                      uint32_t *value, bool *none)
{
    enum shader_file elsewhere = FILE_NONE;
    for (unsigned file = 1; file < FILE_COUNT; file++) {
        const struct shader_register *row = &shader_registers[file];
        size_t length = strlen(row->name);
        struct scan_piece name = {piece.text, length}, digits = {piece.text + length, piece.length - length};
        if (piece.length < length || !scan_piece_is(name, row->name))
            continue;
        if (row->index != NUMBERED ? digits.length != 0 : !read_digits(digits, value, none))
            continue;
        if (shader_register_count(file, model))
            return file;
        elsewhere = file;
    }
    return elsewhere;
}

/* The registers of a model. */
static const char *register_choice(const struct words *words, unsigned index)
{
    return index >= FILE_COUNT                                  ? NULL
           : index && shader_register_count(index, words->list) ? shader_registers[index].name
                                                                : "";
}

/* Reads a register's file and number from the first piece of `rest`. */
static int read_register(struct assembler *assembler, struct scan_piece *rest, struct shader_operand *operand,
                         bool *numbered)
{
    struct scanner *scanner = &assembler->scanner;
    const struct shader_model *model = assembler->shader->model;
    uint32_t number = 0;
    bool none = false;
    if (scanner->token.type != SCAN_WORD)
        return scan_expected(scanner, "a register");
    *rest = (struct scan_piece){scanner->token.text, scanner->token.length};
    struct scan_piece piece = scan_piece_next(rest);
    enum shader_file file = find_register(piece, model, &number, &none);
    if (!file)
        return scan_expected_word(scanner, (struct words){.at = register_choice, .list = model}, piece,
                                  "a register of %s", model->name);
    if (!shader_register_count(file, model))
        return scan_fail(scanner, &scanner->token, 0,
                         "found '%.*s', which %s does not have, expected a register", (int)piece.length,
                         piece.text, model->name);
    *numbered = !none;
    if (shader_registers[file].index != NUMBERED)
        number = 0, *numbered = true;
    if (number > number_limit(file))
        return scan_expected(scanner, "a number from 0 to %u", number_limit(file));
    operand->file = (uint8_t)file;
    operand->index = (uint16_t)number;
    operand->place = (uint16_t)(scanner->token.column < 0xffff ? scanner->token.column : 0);
    return 0;
}

/* --- Relative addressing ------------------------------------------------------------------------------- */

static int read_component(struct assembler *assembler, uint8_t *component)
{
    struct scanner *scanner = &assembler->scanner;
    static const char letters[] = "xyzwrgba";
    if (scan_sign(scanner, '.'))
        return -1;
    const char *found = scanner->token.type == SCAN_WORD && scanner->token.length == 1
                            ? strchr(letters, tolower((unsigned char)*scanner->token.text))
                            : NULL;
    if (!found)
        return scan_expected(scanner, "one of x, y, z and w");
    *component = (uint8_t)((found - letters) & 3);
    return scan_next(scanner);
}

/* a0.x or aL, inside brackets. */
static int read_index_register(struct assembler *assembler, struct shader_operand *operand)
{
    struct scanner *scanner = &assembler->scanner;
    struct shader_operand index = {0};
    struct scan_piece rest;
    bool numbered;
    if (operand->relative)
        return scan_expected(scanner, "one register between the brackets");
    struct scan_token place = scanner->token;
    if (read_register(assembler, &rest, &index, &numbered))
        return -1;
    if ((index.file != FILE_ADDRESS && index.file != FILE_LOOP) || index.index || !numbered || rest.length)
        return scan_expected(scanner, "a0.x, a0.y, a0.z, a0.w or aL");
    operand->relative = index.file;
    if (scan_next(scanner) || (index.file == FILE_ADDRESS && read_component(assembler, &operand->component)))
        return -1;
    if (operand->component && assembler->shader->model->column == COLUMN_VS_1_1)
        return scan_fail(scanner, &place, 0, "found another component than a0.x, the only one in vs_1_1");
    return 0;
}

/* The current token is the bracket. */
static int read_brackets(struct assembler *assembler, struct shader_operand *operand)
{
    struct scanner *scanner = &assembler->scanner;
    uint32_t sum = operand->index;
    do {
        uint32_t term = 0;
        struct scan_token place;
        if (scan_next(scanner))
            return -1;
        place = scanner->token;
        if (scanner->token.type == SCAN_NUMBER
                ? scan_whole(scanner, "a number", number_limit(operand->file), &term)
                : read_index_register(assembler, operand))
            return -1;
        sum += term;
        if (sum > number_limit(operand->file))
            return scan_fail(scanner, &place, 0, "found %s%u, expected a number from 0 to %u",
                             shader_registers[operand->file].name, sum, number_limit(operand->file));
    } while (scan_is(scanner, '+'));
    operand->index = (uint16_t)sum;
    return scan_sign(scanner, ']');
}

/* Reads the register with its brackets; `rest` receives the remainder of the word. */
static int read_place(struct assembler *assembler, struct shader_operand *operand, struct scan_piece *rest)
{
    struct scanner *scanner = &assembler->scanner;
    struct scan_token word = scanner->token;
    bool numbered;
    if (read_register(assembler, rest, operand, &numbered))
        return -1;
    struct scan_piece modifier = *rest;
    if (scan_next(scanner))
        return -1;
    if (!numbered && !(scan_is(scanner, '[') && !modifier.length))
        return scan_fail(scanner, &word, 0, "found '%.*s' without a number, expected one, like %s0",
                         (int)word.length, word.text, shader_registers[operand->file].name);
    if (modifier.length || !scan_is(scanner, '['))
        return 0;
    if (shader_registers[operand->file].index != NUMBERED)
        return scan_expected(scanner, "no index of %s", shader_registers[operand->file].name);
    if (read_brackets(assembler, operand))
        return -1;
    /* After brackets, a modifier is a word of its own. */
    if (scanner->token.type == SCAN_WORD && *scanner->token.text == '_') {
        *rest = (struct scan_piece){scanner->token.text + 1, scanner->token.length - 1};
        return scan_next(scanner);
    }
    return 0;
}

/* --- Components ---------------------------------------------------------------------------------------- */

/* The component of a letter, xyzw or rgba; -1 if none. */
static int component_of(char letter)
{
    static const char letters[] = "xyzwrgba";
    const char *found = memchr(letters, tolower((unsigned char)letter), sizeof letters - 1);
    return found ? (int)((found - letters) & 3) : -1;
}

/* One to four letters; the last one is repeated. */
static int read_swizzle(struct assembler *assembler, uint8_t *swizzle)
{
    struct scanner *scanner = &assembler->scanner;
    const struct scan_token *token = &scanner->token;
    unsigned bits = 0;
    if (!scan_skip(scanner, '.'))
        return 0;
    bool good = token->type == SCAN_WORD && token->length <= 4;
    for (unsigned i = 0; good && i < 4; i++) {
        int component = component_of(token->text[i < token->length ? i : token->length - 1]);
        good = component >= 0;
        bits |= (unsigned)component << 2 * i;
    }
    if (!good)
        return scan_expected(scanner, "one to four of x, y, z, w");
    *swizzle = (uint8_t)bits;
    return scan_next(scanner);
}

/* One to four different letters in order. */
static int read_mask(struct assembler *assembler, uint8_t *mask)
{
    struct scanner *scanner = &assembler->scanner;
    const struct scan_token *token = &scanner->token;
    unsigned bits = 0;
    if (!scan_skip(scanner, '.'))
        return 0;
    bool good = token->type == SCAN_WORD;
    for (size_t i = 0; good && i < token->length; i++) {
        int component = component_of(token->text[i]);
        good = component >= 0 && bits < 1u << component;
        bits |= 1u << (component & 3);
    }
    if (!good)
        return scan_expected(scanner, "some of x, y, z, w in this order");
    *mask = (uint8_t)bits;
    return scan_next(scanner);
}

/* --- Whole operands ------------------------------------------------------------------------------------ */

/* The sign before a register, as the tables write it. */
static int read_sign(struct assembler *assembler, const char **before)
{
    struct scanner *scanner = &assembler->scanner;
    *before = "";
    if (scan_is(scanner, '-'))
        *before = "-";
    else if (scan_is(scanner, '!'))
        *before = "!";
    else if (scanner->token.type == SCAN_NUMBER && scanner->token.length == 1 && *scanner->token.text == '1')
        *before = "1-";
    else
        return 0;
    if (scan_next(scanner))
        return -1;
    return (*before)[0] == '1' ? scan_sign(scanner, '-') : 0;
}

/* The modifiers after a register in a model. */
static const char *modifier_choice(const struct words *words, unsigned index)
{
    const struct shader_model *model = words->list;
    if (index >= MODIFIER_COUNT)
        return NULL;
    const struct shader_modifier *row = &shader_modifiers[index];
    return row->columns[model->column] == '.' ? "" : row->after + (*row->after == '_');
}

/* The modifier with that sign before the register and that name after it. */
static int find_modifier(struct assembler *assembler, const struct scan_token *place, const char *before,
                         struct scan_piece behind, uint8_t *modifier)
{
    static const struct scan_piece z = {"dz", 2}, w = {"dw", 2};
    if (scan_piece_is(behind, "db") || scan_piece_is(behind, "da"))
        behind = scan_piece_is(behind, "db") ? z : w;
    for (unsigned i = 0; i < MODIFIER_COUNT; i++) {
        const struct shader_modifier *row = &shader_modifiers[i];
        if (strcmp(row->before, before) || !scan_piece_is(behind, row->after + (*row->after == '_')))
            continue;
        if (row->columns[assembler->shader->model->column] == '.')
            break;
        *modifier = (uint8_t)i;
        return 0;
    }
    scan_fail(&assembler->scanner, place, 0, "found the modifier '%s%s%.*s', which %s does not have", before,
              behind.length ? "_" : "", (int)behind.length, behind.text, assembler->shader->model->name);
    return words_suggest_in((struct words){.at = modifier_choice, .list = assembler->shader->model},
                            behind.text, behind.length, assembler->scanner.error);
}

int assemble_source(struct assembler *assembler, struct shader_operand *operand)
{
    const char *before;
    struct scan_piece behind;
    struct scan_token place = assembler->scanner.token;
    *operand = (struct shader_operand){.swizzle = SWIZZLE_NONE};
    if (read_sign(assembler, &before) || read_place(assembler, operand, &behind) ||
        find_modifier(assembler, &place, before, behind, &operand->modifier))
        return -1;
    return read_swizzle(assembler, &operand->swizzle);
}

int assemble_destination(struct assembler *assembler, struct shader_operand *operand)
{
    struct scan_piece behind;
    struct scan_token place = assembler->scanner.token;
    *operand = (struct shader_operand){.swizzle = MASK_FULL};
    if (read_place(assembler, operand, &behind))
        return -1;
    if (behind.length)
        return scan_fail(&assembler->scanner, &place, 0,
                         "found the modifier '_%.*s' on a destination, expected none", (int)behind.length,
                         behind.text);
    return read_mask(assembler, &operand->swizzle);
}
