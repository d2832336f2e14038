/* `triptych shader`: shaders as text and as bytecode. The contents determine which of them a file holds. */
#include "base/file.h"
#include "shader/shader.h"
#include "command/support/json.h"
#include "command/support/option.h"

#include <cjson/cJSON.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct settings {
    const char *path, *output;
    bool json;
};

enum { TOKENS_PER_LINE = 6 };

/* The members that every action's report begins with. */
static cJSON *describe(const struct settings *settings, const struct shader *shader)
{
    cJSON *report = cJSON_CreateObject();
    cJSON_AddStringToObject(report, "file", settings->path);
    cJSON_AddStringToObject(report, "model", shader->model->name);
    cJSON_AddNumberToObject(report, "instructions", shader->count);
    return report;
}

/* Writes the report to the file, or to standard output. */
static int send_json(const struct command *self, const struct settings *settings, cJSON *report)
{
    int status = STATUS_OK;
    char *text = NULL;
    if (settings->output)
        status = json_write(self, report, settings->output);
    else if (!(text = json_text(self, report)))
        status = STATUS_BAD;
    else
        puts(text);
    cJSON_free(text);
    cJSON_Delete(report);
    return status;
}

static int send_file(const struct command *self, const struct settings *settings, const void *data,
                     size_t bytes)
{
    struct error error = {""};
    return file_write(settings->output, data, bytes, &error) ? tool_fail(self, "%s", error.text) : STATUS_OK;
}

static int send_tokens(const struct command *self, const struct settings *settings,
                       const struct shader *shader, const uint32_t *tokens, size_t count)
{
    if (settings->json) {
        cJSON *report = describe(settings, shader), *array = cJSON_AddArrayToObject(report, "tokens");
        char text[16];
        for (size_t i = 0; i < count; i++) {
            snprintf(text, sizeof text, "0x%08" PRIx32, tokens[i]);
            cJSON_AddItemToArray(array, cJSON_CreateString(text));
        }
        return send_json(self, settings, report);
    }
    if (settings->output)
        return send_file(self, settings, tokens, count * sizeof *tokens);
    for (size_t i = 0; i < count; i++)
        printf("0x%08" PRIx32 "%c", tokens[i], (i + 1) % TOKENS_PER_LINE && i + 1 < count ? ' ' : '\n');
    return STATUS_OK;
}

static int assemble(const struct command *self, const struct settings *settings, const struct shader *shader)
{
    struct error error = {""};
    uint32_t *tokens;
    size_t count;
    if (shader_encode(shader, &tokens, &count, &error))
        return tool_fail(self, "%s", error.text);
    int status = send_tokens(self, settings, shader, tokens, count);
    free(tokens);
    return status;
}

static int disassemble(const struct command *self, const struct settings *settings,
                       const struct shader *shader)
{
    struct error error = {""};
    char *text;
    size_t bytes;
    int status = STATUS_OK;
    if (shader_print(shader, &text, &bytes, &error))
        return tool_fail(self, "%s", error.text);
    if (settings->json) {
        cJSON *report = describe(settings, shader);
        cJSON_AddStringToObject(report, "text", text);
        status = send_json(self, settings, report);
    } else if (settings->output) {
        status = send_file(self, settings, text, bytes);
    } else {
        fputs(text, stdout);
    }
    free(text);
    return status;
}

static int validate(const struct command *self, const struct settings *settings, const struct shader *shader)
{
    struct error error = {""};
    struct shader_counts counts;
    if (shader_validate(shader, &counts, &error))
        return tool_fail(self, "%s", error.text);
    if (settings->json) {
        cJSON *report = describe(settings, shader);
        cJSON_AddNumberToObject(report, "slots", counts.slots);
        cJSON_AddNumberToObject(report, "flow", counts.flow);
        return send_json(self, settings, report);
    }
    char text[128];
    int length = snprintf(text, sizeof text, "valid %s: %" PRIu32 " instructions, %u slots\n",
                          shader->model->name, shader->count, counts.slots);
    if (settings->output)
        return send_file(self, settings, text, (size_t)length);
    fputs(text, stdout);
    return STATUS_OK;
}

static const struct action {
    const char *name;
    int (*run)(const struct command *self, const struct settings *settings, const struct shader *shader);
} actions[] = {
    {"assemble", assemble},
    {"disassemble", disassemble},
    {"validate", validate},
};

static const char notes[] =
    "FILE is the text or the bytecode of a shader (docs/shaders.md).\n"
    "assemble      writes its tokens: little-endian to the file of --out, or as text\n"
    "disassemble   writes its text\n"
    "validate      checks that a device can run it, and reports its use of the model's limits";

static int run(const struct command *self, void *data, const struct operands *operands)
{
    struct settings *settings = data;
    struct shader *shader;
    struct error error = {""};
    if (tool_check_output(self, settings->output))
        return STATUS_BAD;
    settings->path = operands->value[1];
    if (shader_load(settings->path, &shader, &error))
        return tool_fail(self, "%s", error.text);
    int status = actions[operands->word].run(self, settings, shader);
    shader_free(shader);
    return status;
}

static const char *action_at(unsigned index)
{
    return index < sizeof actions / sizeof *actions ? actions[index].name : NULL;
}

static const struct option options[] = {
    {"out", "FILE", "where to write the result; standard output", OPTION_IS_FILE(struct settings, output)},
    {"json", NULL, "the result as JSON", OPTION_IS_FLAG(struct settings, json)},
    {0},
};

static const struct operand operands[] = {
    {"ACTION", "assemble, disassemble or validate", .kind = OPERAND_WORD, .words = action_at},
    {"FILE", "the text or the bytecode of a shader", .kind = OPERAND_INPUT},
    {0},
};

const struct command command_shader = {
    .name = "shader",
    .summary = "assemble, disassemble or validate a shader",
    .options = options,
    .operands = operands,
    .notes = notes,
    .settings_bytes = sizeof(struct settings),
    .run = run,
};
