/* The completions of shells. Each is a script whose rows follow from the tables of commands. */
#include "command/support/option.h"
#include "command/tool/command_line.h"
#include "command/tool/manual.h"

#include <string.h>

static bool is_path(const struct option *option)
{
    return option->kind == OPTION_FILE || option->kind == OPTION_INPUT;
}

/* The words with spaces between them. */
static void put_words(option_words *words, FILE *out)
{
    const char *word;
    for (unsigned i = 0; (word = words(i)); i++)
        fprintf(out, "%s%s", i ? " " : "", word);
}

/* A text between single quotes; `signs` get a backslash before them. In fish, \' is a quote; elsewhere the
 * text is interrupted. */
static void put_quoted(const char *text, const char *signs, bool fish, FILE *out)
{
    for (; *text; text++) {
        if (*text == '\'') {
            fputs(fish ? "\\'" : "'\\''", out);
            continue;
        }
        if (strchr(signs, *text))
            putc('\\', out);
        putc(*text, out);
    }
}

/* --- bash ----------------------------------------------------------------------------------------------- */

static const char bash_begin[] =
    "# Completion of triptych for bash, written by `triptych help --as bash`.\n"
    "\n"
    "_triptych_words() # WORDS\n"
    "{\n"
    "    mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$current\")\n"
    "}\n"
    "\n"
    "_triptych_list() # WORDS: after the last comma\n"
    "{\n"
    "    local begin=\n"
    "    [[ $current == *,* ]] && begin=${current%,*},\n"
    "    mapfile -t COMPREPLY < <(compgen -P \"$begin\" -W \"$1\" -- \"${current##*,}\")\n"
    "    compopt -o nospace 2>/dev/null\n"
    "}\n"
    "\n"
    "_triptych_files() # [EXTENSION...]: files with one of them, or all; and folders\n"
    "{\n"
    "    local extension\n"
    "    mapfile -t COMPREPLY < <(\n"
    "        if (($#)); then compgen -d -- \"$current\"; else compgen -f -- \"$current\"; fi\n"
    "        for extension; do compgen -f -X \"!*.$extension\" -- \"$current\"; done\n"
    "    )\n"
    "    compopt -o filenames 2>/dev/null\n"
    "}\n"
    "\n"
    "# COMP_WORDBREAKS contains =, so --name=value is three words.\n"
    "_triptych()\n"
    "{\n"
    "    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}\n"
    "    local command=${COMP_WORDS[1]} values= number=0 i\n"
    "    COMPREPLY=()\n"
    "    [[ $before == = ]] && before=${COMP_WORDS[COMP_CWORD - 2]}\n"
    "    [[ $current == = ]] && current=\n"
    "    if ((COMP_CWORD == 1)); then\n";

static const char bash_operands[] =
    "    for ((i = 2; i < COMP_CWORD; i++)); do\n"
    "        if [[ ${COMP_WORDS[i]} == = ]]; then\n"
    "            ((i++))\n"
    "        elif [[ \" $values \" == *\" ${COMP_WORDS[i]} \"* && ${COMP_WORDS[i + 1]} != = ]]; then\n"
    "            ((i++))\n"
    "        elif [[ ${COMP_WORDS[i]} != -?* ]]; then\n"
    "            ((++number))\n"
    "        fi\n"
    "    done\n";

/* Prints the command of the script that completes the value of an option. */
static void put_bash_value(const struct option *option, FILE *out)
{
    if (option->words) {
        fprintf(out, "_triptych_%s '", option->kind == OPTION_LIST ? "list" : "words");
        put_words(option->words, out);
        putc('\'', out);
    } else if (is_path(option)) {
        fprintf(out, "_triptych_files %s", option->extension ? option->extension : "");
    } else if (option->kind == OPTION_FOLDER) {
        fputs("_triptych_files /", out);
    } else {
        putc(':', out);
    }
}

static void put_bash_options(const struct command *command, FILE *out)
{
    for (const struct option *option = command->options; option && option->name; option++) {
        if (option->kind == OPTION_FLAG)
            continue;
        fprintf(out, "        %s,--%s) ", command->name, option->name);
        put_bash_value(option, out);
        fputs("; return ;;\n", out);
    }
}

/* The lists of options: all of them, and those with values. */
static void put_bash_names(const struct command *command, FILE *out)
{
    fprintf(out, "        %s)\n            values='", command->name);
    for (const struct option *option = command->options; option && option->name; option++)
        if (option->kind != OPTION_FLAG)
            fprintf(out, " --%s", option->name);
    fputs("'\n            [[ $current != -* ]] || _triptych_words '", out);
    for (const struct option *option = command->options; option && option->name; option++)
        fprintf(out, "--%s ", option->name);
    fputs("--help' ;;\n", out);
}

static void put_bash_operands(const struct command *command, FILE *out)
{
    unsigned number = 0;
    for (const struct operand *operand = command->operands; operand && operand->name; operand++, number++) {
        fprintf(out, "        %s,", command->name);
        if (operand->repeated)
            fputs("*) ", out);
        else
            fprintf(out, "%u) ", number);
        if (operand->words) {
            fputs("_triptych_words '", out);
            put_words(operand->words, out);
            fputs("' ;;\n", out);
        } else {
            fprintf(out, "_triptych_files %s ;;\n", operand->extension ? operand->extension : "");
        }
    }
}

static void put_bash_cases(const char *subject, void (*put)(const struct command *command, FILE *out),
                           FILE *out)
{
    const struct command *command;
    fprintf(out, "    case %s in\n", subject);
    for (unsigned i = 0; (command = command_line_at(i)); i++)
        put(command, out);
    fputs("    esac\n", out);
}

void completion_print_bash(FILE *out)
{
    fputs(bash_begin, out);
    fputs("        _triptych_words '", out);
    put_words(command_line_name, out);
    fputs(" --help --version'\n        return\n    fi\n", out);
    put_bash_cases("$command,$before", put_bash_options, out);
    put_bash_cases("$command", put_bash_names, out);
    fputs("    [[ $current != -* ]] || return 0\n", out);
    fputs(bash_operands, out);
    put_bash_cases("$command,$number", put_bash_operands, out);
    fputs("}\n\ncomplete -F _triptych triptych\n", out);
}

/* --- zsh ------------------------------------------------------------------------------------------------ */

static void put_zsh_files(const char *extension, FILE *out)
{
    fputs("_files", out);
    if (!extension)
        return;
    fputs(" -g \"*.(", out);
    for (; *extension; extension++)
        putc(*extension == ' ' ? '|' : *extension, out);
    fputs(")(-.)\"", out);
}

/* The part of an option's row after its meaning: `:NAME:ACTION`. */
static void put_zsh_value(const struct option *option, FILE *out)
{
    putc(':', out);
    put_quoted(option->argument, ":", false, out);
    putc(':', out);
    if (option->words && option->kind == OPTION_LIST)
        fputs("_values -s , word ", out);
    if (option->words)
        fputs(option->kind == OPTION_LIST ? "" : "(", out), put_words(option->words, out);
    if (option->words && option->kind != OPTION_LIST)
        putc(')', out);
    if (is_path(option))
        put_zsh_files(option->extension, out);
    if (option->kind == OPTION_FOLDER)
        fputs("_files -/", out);
}

static void put_zsh_option(const struct option *option, FILE *out)
{
    char meaning[OPTIONS_MEANING];
    fprintf(out, "                '--%s%s[", option->name, option->kind == OPTION_FLAG ? "" : "=");
    put_quoted(options_meaning(option, meaning), "[]:", false, out);
    putc(']', out);
    if (option->kind != OPTION_FLAG)
        put_zsh_value(option, out);
    fputs("' \\\n", out);
}

static void put_zsh_operand(const struct operand *operand, FILE *out)
{
    fprintf(out, "                '%s%s:%s:", operand->repeated ? "*" : "", operand->optional ? ":" : "",
            operand->name);
    if (operand->words) {
        putc('(', out);
        put_words(operand->words, out);
        putc(')', out);
    } else {
        put_zsh_files(operand->extension, out);
    }
    fputs("' \\\n", out);
}

static void put_zsh_command(const struct command *command, FILE *out)
{
    fprintf(out, "        %s)\n            _arguments \\\n", command->name);
    for (const struct option *option = command->options; option && option->name; option++)
        put_zsh_option(option, out);
    for (const struct operand *operand = command->operands; operand && operand->name; operand++)
        put_zsh_operand(operand, out);
    fputs("                '(-)'{-h,--help}'[the options]' ;;\n", out);
}

void completion_print_zsh(FILE *out)
{
    const struct command *command;
    fputs("#compdef triptych\n"
          "# Completion of triptych for zsh, written by `triptych help --as zsh`.\n\n"
          "_triptych()\n{\n"
          "    local context state line curcontext=$curcontext\n"
          "    local -a commands\n"
          "    commands=(\n",
          out);
    for (unsigned i = 0; (command = command_line_at(i)); i++) {
        fprintf(out, "        '%s:", command->name);
        put_quoted(command->summary, ":", false, out);
        fputs("'\n", out);
    }
    fputs("    )\n"
          "    _arguments -C '(-)'{-h,--help}'[the commands]' '(-)--version[the version]' \\\n"
          "        '1:command:->command' '*::argument:->argument' && return\n"
          "    [[ $state != command ]] || _describe command commands\n"
          "    [[ $state == argument ]] || return\n"
          "    case $words[1] in\n",
          out);
    for (unsigned i = 0; (command = command_line_at(i)); i++)
        put_zsh_command(command, out);
    fputs("    esac\n}\n\n_triptych \"$@\"\n", out);
}

/* --- fish ----------------------------------------------------------------------------------------------- */

/* A row that applies after the command. */
static void begin_fish(const struct command *command, FILE *out)
{
    fprintf(out, "complete -c triptych -n '__fish_seen_subcommand_from %s'", command->name);
}

static void put_fish_meaning(const char *meaning, FILE *out)
{
    fputs(" -d '", out);
    put_quoted(meaning, "\\", true, out);
    fputs("'\n", out);
}

static void put_fish_option(const struct command *command, const struct option *option, FILE *out)
{
    char meaning[OPTIONS_MEANING];
    begin_fish(command, out);
    fprintf(out, " -l %s", option->name);
    if (is_path(option))
        fputs(" -r", out);
    else if (option->kind == OPTION_FOLDER)
        fputs(" -x -a '(__fish_complete_directories)'", out);
    else if (option->kind != OPTION_FLAG)
        fputs(" -x", out);
    if (option->words) {
        fputs(option->kind == OPTION_LIST ? " -a '(__fish_append , " : " -a '", out);
        put_words(option->words, out);
        fputs(option->kind == OPTION_LIST ? ")'" : "'", out);
    }
    put_fish_meaning(options_meaning(option, meaning), out);
}

static void put_fish_operand(const struct command *command, const struct operand *operand, FILE *out)
{
    if (!operand->words && !operand->extension)
        return;
    begin_fish(command, out);
    fputs(operand->words ? " -f -a '" : " -k -a '(", out);
    if (operand->words)
        put_words(operand->words, out);
    for (const char *at = operand->words ? NULL : operand->extension; at && *at;) {
        size_t length = strcspn(at, " ");
        fprintf(out, "__fish_complete_suffix .%.*s; ", (int)length, at);
        at += length + (at[length] == ' ');
    }
    fputs(operand->words ? "'" : ")'", out);
    put_fish_meaning(operand->meaning, out);
}

void completion_print_fish(FILE *out)
{
    const struct command *command;
    fputs("# Completion of triptych for fish, written by `triptych help --as fish`.\n"
          "complete -c triptych -s h -l help -d 'the options'\n"
          "complete -c triptych -n __fish_use_subcommand -l version -d 'the version'\n",
          out);
    for (unsigned i = 0; (command = command_line_at(i)); i++) {
        fprintf(out, "complete -c triptych -n __fish_use_subcommand -f -a %s", command->name);
        put_fish_meaning(command->summary, out);
        for (const struct option *option = command->options; option && option->name; option++)
            put_fish_option(command, option, out);
        for (const struct operand *operand = command->operands; operand && operand->name; operand++)
            put_fish_operand(command, operand, out);
    }
}
