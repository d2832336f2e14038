#include "command/list/shaders.h"
#include "shader/shader.h"
#include "command/support/table.h"

#include <stdlib.h>
#include <string.h>

enum { TEXT = 160 };

/* The name of each column: that of its first model. */
static const char *column_name(unsigned column)
{
    for (unsigned i = 0; i < MODEL_COUNT; i++)
        if (shader_models[i].column == column)
            return shader_models[i].name;
    return "";
}

static void append(char text[TEXT], const char *more)
{
    snprintf(text + strlen(text), TEXT - strlen(text), "%s%s", text[0] ? " " : "", more);
}

/* The syntax of an instruction, with letters for its operands. */
static const char *syntax(const struct shader_operation *row, char text[TEXT])
{
    static const char *const destinations[] = {
        [OPERAND_RESULT] = "dst",
        [OPERAND_ADDRESS] = "a0",
        [OPERAND_FLAGS] = "p0",
        [OPERAND_STAGE] = "t#",
        [OPERAND_TEMPORARY] = "r#",
        [OPERAND_KILL] = "dst",
        [OPERAND_DECLARED] = "register",
        [OPERAND_CONSTANT] = "c#, x, y, z, w",
        [OPERAND_CONSTANT_INTEGER] = "i#, x, y, z, w",
        [OPERAND_CONSTANT_BOOLEAN] = "b#, true",
    };
    static const char *const sources[] = {
        [OPERAND_SAMPLER] = "s#",  [OPERAND_INTEGER] = "i#",     [OPERAND_COUNTER] = "aL",
        [OPERAND_LABEL] = "l#",    [OPERAND_PREDICATE] = "p0.x", [OPERAND_CONDITION] = "b# | p0.x",
        [OPERAND_SCRATCH] = "r#",  [OPERAND_SERIES] = "c#",      [OPERAND_SAMPLED] = "t#",
        [OPERAND_SET] = "t# | r#",
    };
    static const char *const letters[] = {"a", "b", "c", "d"};
    int length =
        snprintf(text, TEXT, "%s%s%s%s", row->name, row->control == COMPARISON ? "_cmp" : "",
                 row->destination ? " " : "", row->destination ? destinations[row->destination] : "");
    for (unsigned i = 0; i < SHADER_SOURCES && row->source[i]; i++) {
        unsigned kind = row->source[i];
        bool named = kind < sizeof sources / sizeof *sources && sources[kind];
        length += snprintf(text + length, TEXT - (size_t)length, "%s %s%s", i || row->destination ? "," : "",
                           named ? sources[kind] : letters[i], kind == OPERAND_SCALAR ? ".x" : "");
    }
    return text;
}

/* The slots in one column; empty if the models do not have the instruction. */
static const char *slots_text(const struct shader_operation *row, unsigned column, char text[TEXT])
{
    text[0] = 0;
    for (unsigned i = 0; i < MODEL_COUNT; i++)
        if (shader_models[i].column == column && shader_slots(row, &shader_models[i]) >= 0)
            snprintf(text, TEXT, "%d", shader_slots(row, &shader_models[i]));
    if (text[0] && row->cube && strstr(column_name(column), "3_0"))
        snprintf(text + strlen(text), TEXT - strlen(text), " (%d)", atoi(text) + row->cube);
    return text;
}

static const char *limit_text(unsigned limit, char text[TEXT])
{
    snprintf(text, TEXT, limit ? "%u" : "-", limit);
    return text;
}

static const char *capabilities_text(const struct shader_model *model, char text[TEXT])
{
    static const struct {
        uint8_t capability;
        const char *name;
    } rows[] = {
        {CAN_PREDICATION, "predication"}, {CAN_SWIZZLE, "swizzles"},  {CAN_DIFFERENCE, "gradients"},
        {CAN_DEPENDENT, "dependent"},     {CAN_SOFTWARE, "software"}, {CAN_OPENGL, "opengl"},
    };
    text[0] = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (model->capabilities & rows[i].capability)
            append(text, rows[i].name);
    return text;
}

/* --- For programs --- */

void shaders_list(cJSON *rows)
{
    char text[TEXT];
    for (unsigned i = 0; i < SHADER_COUNT; i++) {
        const struct shader_operation *operation = &shader_operations[i];
        cJSON *row = cJSON_CreateObject(), *slots;
        cJSON_AddItemToArray(rows, row);
        cJSON_AddStringToObject(row, "instruction", operation->name);
        cJSON_AddStringToObject(row, "syntax", syntax(operation, text));
        cJSON_AddNumberToObject(row, "opcode", operation->opcode);
        slots = cJSON_AddObjectToObject(row, "slots");
        for (unsigned m = 0; m < MODEL_COUNT; m++)
            if (shader_slots(operation, &shader_models[m]) >= 0)
                cJSON_AddNumberToObject(slots, shader_models[m].name,
                                        shader_slots(operation, &shader_models[m]));
        cJSON_AddStringToObject(row, "meaning", operation->meaning);
    }
}

/* --- For people --- */

static void print_models(FILE *out)
{
    static const char *const headings[] = {"model",    "slots",   "arithmetic", "texture", "r",   "flow",
                                           "branches", "dynamic", "loops",      "calls",   "also"};
    char text[TEXT];
    struct table table = {0};
    for (unsigned i = 0; i < sizeof headings / sizeof *headings; i++)
        table_column(&table, headings[i], i && i < 10 ? TABLE_RIGHT : TABLE_LEFT);
    for (unsigned i = 0; i < MODEL_COUNT; i++) {
        const struct shader_model *model = &shader_models[i];
        const unsigned limits[] = {model->slots,       model->arithmetic, model->texture,
                                   model->temporaries, model->flow,       model->branches,
                                   model->dynamic,     model->loops,      model->calls};
        table_cell(&table, "%s", model->name);
        for (unsigned j = 0; j < sizeof limits / sizeof *limits; j++)
            table_cell(&table, "%s", limit_text(limits[j], text));
        table_cell(&table, "%s", capabilities_text(model, text));
    }
    table_print(&table, 0, out);
    fputc('\n', out);
}

/* Prints a table with one column per model: the headings, then the text of `cell` for each row. */
static void print_columns(const char *heading, unsigned count,
                          const char *(*name)(unsigned row, char text[TEXT]),
                          const char *(*cell)(unsigned row, unsigned column, char text[TEXT]), FILE *out)
{
    char text[TEXT];
    struct table table = {0};
    table_column(&table, heading, TABLE_LEFT);
    for (unsigned column = 0; column < COLUMN_COUNT; column++)
        table_column(&table, column_name(column), TABLE_RIGHT);
    for (unsigned row = 0; row < count; row++) {
        table_cell(&table, "%s", name(row, text));
        for (unsigned column = 0; column < COLUMN_COUNT; column++)
            table_cell(&table, "%s", cell(row, column, text));
    }
    table_print(&table, 0, out);
    fputc('\n', out);
}

static const char *operation_syntax(unsigned row, char text[TEXT])
{
    return syntax(&shader_operations[row], text);
}

static const char *operation_slots(unsigned row, unsigned column, char text[TEXT])
{
    return slots_text(&shader_operations[row], column, text);
}

static const char *register_name(unsigned row, char text[TEXT])
{
    const struct shader_register *file = &shader_registers[row + 1];
    snprintf(text, TEXT, "%s%s", file->name, file->index == NUMBERED ? "#" : "");
    return text;
}

/* The number of registers, and of those that one instruction can read: 12/3. */
static const char *register_count(unsigned row, unsigned column, char text[TEXT])
{
    const struct shader_register *file = &shader_registers[row + 1];
    if (!file->count[column])
        return "";
    int length = snprintf(text, TEXT, "%u", file->count[column]);
    if (file->ports[column] != '0')
        snprintf(text + length, TEXT - (size_t)length, "/%c", file->ports[column]);
    return text;
}

void shaders_print(FILE *out)
{
    print_models(out);
    print_columns("registers/ports", FILE_COUNT - 1, register_name, register_count, out);
    print_columns("instruction (slots)", SHADER_COUNT, operation_syntax, operation_slots, out);
}

/* The page docs/shaders.md. */

static const char introduction[] =
    "# Shaders\n"
    "\n"
    "> **For:** shader models 1.1 to 3.0 of Direct3D 9 and vs_gl and ps_gl: their text, bytecode,\n"
    "> instructions, registers and rules. **Read it** to write a shader or to look up an instruction.\n"
    "> **Run** `build/triptych shader validate FILE`; `assemble` and `disassemble` convert between both\n"
    "> forms.\n"
    "\n"
    "`triptych list shaders --markdown` writes this page from the tables `src/def/shader/*.def`. The\n"
    "assembler, the bytecode reader, the disassembler and the validator use the same tables. The\n"
    "results of instructions are defined in [shader-semantics.md](shader-semantics.md).\n"
    "\n"
    "## Text\n"
    "\n"
    "```\n"
    "ps_2_0                      ; the model comes first: ps_2_0 or ps.2.0\n"
    "def c0, 1, 0.5, -2, 1e-3    // constants: def, defi i0, 1, 2, 3, 4, defb b0, true\n"
    "dcl t0.xy                   /* declarations: dcl_position v0, dcl_texcoord3 o1.xy */\n"
    "dcl_2d s0\n"
    "texld_pp r0, t0, s0\n"
    "mad_sat r0.xyz, r0, c0.x, -c0.w\n"
    "mov oC0, r0\n"
    "```\n"
    "\n"
    "- A line has one instruction. Comments are from `;` or `//` to the end of the line, or between\n"
    "  `/*` and `*/`. Small and capital letters are equal.\n"
    "- An instruction's name can have suffixes: first a comparison (`if_lt`, `break_ge`, `setp_ne`),\n"
    "  then modifiers of the result: `_sat`, `_pp`, `_centroid` (of dcl), `_x2`, `_x4`, `_x8`, `_d2`,\n"
    "  `_d4`, `_d8`.\n"
    "- A destination can have a mask, `r0.xz`. A source can have modifiers and a swizzle,\n"
    "  `-r0_bx2.wzyx`. The last letter of a swizzle is repeated. `r`, `g`, `b`, `a` mean `x`, `y`,\n"
    "  `z`, `w`.\n"
    "- `c[a0.x + 5]`, `c5[a0.x]`, `v[aL]`, `o[aL + 1]` are relative addresses. Numbers in brackets\n"
    "  are added.\n"
    "- `(p0.x) mov ...` and `(!p0) mov ...` are predicated. `+mov ...` is issued together with the\n"
    "  previous instruction (models ps_1_x).\n"
    "- Numbers of def can be bits, `0x7fc00000`.\n"
    "\n"
    "The disassembler writes canonical text, which assembles to the same tokens: small letters; `x`\n"
    "to `w`; no default mask or swizzle; one letter for a repeated component, otherwise four; indices\n"
    "as `c5[a0.x]`; numbers as the shortest decimals with the same bits. Names in a compiler's\n"
    "constant table become comments. In bytecode vs_2_a is vs_2_x, and ps_2_a and ps_2_b are ps_2_x.\n"
    "\n"
    "## Bytecode\n"
    "\n"
    "Bytecode consists of little-endian 32-bit words, as in Direct3D 9: a version token, instructions\n"
    "with their operands, the end token. `src/shader/code/token.h` describes the fields. Reserved\n"
    "bits must be zero, lengths must be right, and nothing follows the end. A shader has at most\n"
    "65536 instructions, a file 16777216 bytes.\n"
    "\n"
    "## Rules\n"
    "\n"
    "An error message has the position, `FILE:LINE:COLUMN` or `FILE: token N`, what was found and\n"
    "what was expected. Only the first error is reported. Besides the limits in the tables below:\n"
    "\n"
    "- dcl and def come first. Inputs, samplers and outputs are declared before they are used, except\n"
    "  in ps_1_x.\n"
    "- An instruction reads only components that an earlier instruction can have written.\n"
    "- Blocks are closed in the right order. Calls go forward. Subroutines follow the main program's\n"
    "  ret.\n"
    "- Gradients of computed values (texld, texldb, texldp, dsx, dsy of r#) are not allowed where\n"
    "  neighbouring pixels can take different paths.\n"
    "- vs_1_1 to vs_2_x write all of oPos, vs_3_0 all of the output declared as position, ps_1_x all\n"
    "  of r0, ps_2_x oC0.\n"
    "- Models ps_2_x write oC# and oDepth completely, by mov, once. ps_1_1 to ps_1_3 use texture\n"
    "  stages in order, before arithmetic; ps_1_4 does so in each of its two phases.\n"
    "- vs_gl and ps_gl have the rules of models 3.0 except those that\n"
    "  [shader-semantics.md](shader-semantics.md#models-of-opengl-vs_gl-and-ps_gl) lifts.\n";

static void markdown_head(const char *first, FILE *out)
{
    fprintf(out, "\n| %s |", first);
    for (unsigned column = 0; column < COLUMN_COUNT; column++)
        fprintf(out, " %s |", column_name(column));
    fputs(" Meaning |\n| --- |", out);
    for (unsigned column = 0; column < COLUMN_COUNT; column++)
        fputs(" --- |", out);
    fputs(" --- |\n", out);
}

static void markdown_models(FILE *out)
{
    char text[TEXT];
    fputs("\n## Models\n"
          "\n"
          "Limits of a model: slots in total, of arithmetic, and of texture instructions (in ps_1_4 in each\n"
          "phase); temporaries; instructions of static flow control in total; nesting of branches on\n"
          "constants, of branches on values, of loops and of calls.\n"
          "\n"
          "| Model | Slots | Arithmetic | Texture | r# | Flow | Branches | Dynamic | Loops | Calls | Also |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
          out);
    for (unsigned i = 0; i < MODEL_COUNT; i++) {
        const struct shader_model *model = &shader_models[i];
        const unsigned limits[] = {model->slots,       model->arithmetic, model->texture,
                                   model->temporaries, model->flow,       model->branches,
                                   model->dynamic,     model->loops,      model->calls};
        fprintf(out, "| %s |", model->name);
        for (unsigned j = 0; j < sizeof limits / sizeof *limits; j++)
            fprintf(out, " %s |", limit_text(limits[j], text));
        fprintf(out, " %s |\n", capabilities_text(model, text));
    }
}

static void markdown_registers(FILE *out)
{
    char text[TEXT];
    fputs("\n## Registers\n"
          "\n"
          "The number of registers, and after the slash the number of different ones that an instruction\n"
          "can read. Software models (_sw) have no limit of the second kind. Their numbers of registers are\n"
          "larger: ",
          out);
    const char *between = "";
    for (unsigned file = 1; file < FILE_COUNT; file++)
        if (shader_registers[file].software) {
            fprintf(out, "%s%u %s", between, shader_registers[file].software, register_name(file - 1, text));
            between = ", ";
        }
    fputs(".\nA device has only b0 to b15: it refuses a shader of a software model that uses others.\n", out);
    markdown_head("Register", out);
    for (unsigned file = 1; file < FILE_COUNT; file++) {
        fprintf(out, "| `%s` |", register_name(file - 1, text));
        for (unsigned column = 0; column < COLUMN_COUNT; column++)
            fprintf(out, " %s |", register_count(file - 1, column, text));
        fprintf(out, " %s |\n", shader_registers[file].meaning);
    }
}

/* Prints text in a table's cell. A vertical bar would end the cell, so it is escaped. */
static void print_cell(const char *text, FILE *out)
{
    for (; *text; text++)
        fprintf(out, *text == '|' ? "\\|" : "%c", *text);
}

static void markdown_instructions(FILE *out)
{
    char text[TEXT];
    fputs("\n## Instructions\n"
          "\n"
          "The slots of each instruction, in brackets if it samples a cube. `_cmp` is one of ",
          out);
    for (unsigned i = 0; shader_comparisons[i].name; i++)
        fprintf(out, "%s`_%s`", i ? ", " : "", shader_comparisons[i].name);
    fputs(". A predicate adds one slot. The second\n"
          "instruction of a pair needs none.\n",
          out);
    markdown_head("Instruction", out);
    for (unsigned i = 0; i < SHADER_COUNT; i++) {
        fputs("| `", out);
        print_cell(operation_syntax(i, text), out);
        fputs("` |", out);
        for (unsigned column = 0; column < COLUMN_COUNT; column++)
            fprintf(out, " %s |", operation_slots(i, column, text));
        fputc(' ', out);
        print_cell(shader_operations[i].meaning, out);
        fputs(" |\n", out);
    }
}

static void markdown_modifiers(FILE *out)
{
    fputs("\n## Source modifiers\n", out);
    markdown_head("Modifier", out);
    for (unsigned i = 1; i < MODIFIER_COUNT; i++) {
        fprintf(out, "| `%sa%s` |", shader_modifiers[i].before, shader_modifiers[i].after);
        for (unsigned column = 0; column < COLUMN_COUNT; column++)
            fputs(shader_modifiers[i].columns[column] == '.' ? "  |" : " yes |", out);
        fputc(' ', out);
        print_cell(shader_modifiers[i].meaning, out);
        fputs(" |\n", out);
    }
}

static void markdown_words(const char *title, const struct shader_word *words, FILE *out)
{
    fprintf(out, "\n%s: ", title);
    for (unsigned i = 0; words[i].name; i++)
        fprintf(out, "%s`%s`", i ? ", " : "", words[i].name);
    fputs(".\n", out);
}

void shaders_print_markdown(FILE *out)
{
    fputs(introduction, out);
    markdown_models(out);
    markdown_registers(out);
    markdown_instructions(out);
    markdown_modifiers(out);
    fputs("\n## Words of dcl\n", out);
    markdown_words("Usages, followed by a number from 0 to 15", shader_usages, out);
    markdown_words("Textures of samplers", shader_kinds, out);
}
