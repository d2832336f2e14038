# Prints the enumerations of the public header that follow from tables: states, values of states, and formats.
# Make writes them to triptych_words.h, which triptych.h includes, and joins both for installation.
#
#   awk -f src/words.awk src/def/state/{kind,state,sampler_state,stage_state,value,...}.def
#
# kind.def comes first, because other tables name its rows. A row has one line.

# Splits a row at the commas outside quotes and parentheses into column[1], column[2], ... without blanks at
# the ends.
function split_row(row,    i, c, quoted, depth, n, text) {
    sub(/^[A-Z_0-9]+\(/, "", row)
    sub(/\)[ \t]*$/, "", row)
    n = 0
    text = ""
    for (i = 1; i <= length(row) + 1; i++) {
        c = substr(row, i, 1)
        if (c == "\"")
            quoted = !quoted
        depth += quoted ? 0 : (c == "(") - (c == ")")
        if (i > length(row) || (c == "," && !quoted && !depth)) {
            gsub(/^[ \t]+|[ \t]+$/, "", text)
            column[++n] = text
            text = ""
        } else
            text = text c
    }
    return n
}

function meaning(text) {
    gsub(/^"|"$/, "", text)
    return text
}

# Adds an enumerator to an enumeration; a second one with the same value is left out.
function add(enumeration, name, value, comment,    line) {
    if ((enumeration, name) in known) {
        if (known[enumeration, name] != value) {
            print FILENAME ": " name " is " value " and " known[enumeration, name] >"/dev/stderr"
            failed = 1
        }
        return
    }
    known[enumeration, name] = value
    line = "    TRIPTYCH_" name (value == "" ? "" : " = " value) ","
    if (comment != "" && length(line comment) > 100)
        line = "    /* " comment " */\n" line
    else if (comment != "")
        line = line " /* " comment " */"
    body[enumeration] = body[enumeration] line "\n"
}

function begin(enumeration, comment) {
    if (!(enumeration in body)) {
        order[++enumerations] = enumeration
        introduction[enumeration] = comment
        body[enumeration] = ""
    }
}

function state_row(enumeration, prefix, comment) {
    begin(enumeration, comment)
    add(enumeration, prefix toupper(column[2]), "", values[column[3]] ": " meaning(column[columns]))
}

BEGIN {
    support["LATER"] = "not in this version"
    support["NEVER"] = "not supported"
}

/^[A-Z_]+\(/ { columns = split_row($0) }

/^KIND\(/ {
    prefix[column[1]] = column[3]
    values[column[1]] = column[3] == "" ? tolower(column[1]) : "TRIPTYCH_" column[3] "_..."
    if (column[3] in kinds)
        kinds[column[3]] = kinds[column[3]] " and " tolower(column[1])
    else
        kinds[column[3]] = tolower(column[1])
}

/^STATE\(/ { state_row("state", "STATE_", "Render states, for triptych_set_state.") }
/^SAMPLER_STATE\(/ { state_row("sampler_state", "SAMPLER_", "Sampler states, for triptych_set_sampler_state.") }
/^STAGE_STATE\(/ { state_row("stage_state", "STAGE_", "Texture stage states, for triptych_set_stage_state.") }

/^VALUE\(/ {
    begin(tolower(prefix[column[1]]), "Values of states: " kinds[prefix[column[1]]] ".")
    add(tolower(prefix[column[1]]), prefix[column[1]] "_" toupper(column[2]), column[3], support[column[4]])
}

/^FVF\(/ { codes = codes "#define TRIPTYCH_FVF_" toupper(column[1]) " " column[3] "u /* " meaning(column[4]) " */\n" }

/^ATTRIBUTE\(/ {
    begin("attribute", "Vertex attributes of the fixed-function pipeline.")
    add("attribute", column[1], "", meaning(column[5]))
}

/^VERTEX_TYPE\(/ {
    if (!("format" in body)) {
        begin("format", "Memory formats of vertex attributes: Direct3D 9's D3DDECLTYPE, plus 1; then others.")
        add("format", "FORMAT_NONE", "", "the attribute is absent")
    }
    add("format", "FORMAT_" column[1], "", meaning(column[7]))
}

/^FORMAT\(/ {
    begin("surface_format", "Formats of textures and targets, by Direct3D 9's numbers.")
    add("surface_format", "SURFACE_" toupper(column[1]), column[2], "")
}

/^DEPTH_FORMAT\(/ {
    begin("depth_format", "Formats of the depth surface.")
    add("depth_format", "DEPTH_" column[1], "", meaning(column[6]))
}

/^PRIMITIVE\(/ {
    begin("primitive", "Primitives: each with the vertices of primitive p of a draw, the provoking vertex first.")
    add("primitive", column[1], "", meaning(column[7]))
}

END {
    last["state"] = "STATE_COUNT"
    last["sampler_state"] = "SAMPLER_STATE_COUNT"
    last["stage_state"] = "STAGE_STATE_COUNT"
    last["attribute"] = "ATTRIBUTE_COUNT"
    last["format"] = "FORMAT_COUNT"
    last["depth_format"] = "DEPTH_COUNT"
    last["primitive"] = "PRIMITIVE_COUNT"
    print "/* Written by src/words.awk from the tables in src/def/state. */"
    for (i = 1; i <= enumerations; i++) {
        name = order[i]
        print "\n/* " introduction[name] " */\nenum triptych_" name " {"
        printf "%s", body[name]
        if (name in last)
            print "    TRIPTYCH_" last[name]
        print "};"
    }
    print "\n/* The parts of a vertex format code (triptych_set_fvf), which are added. */"
    printf "%s", codes
    exit failed
}
