#!/usr/bin/env bash
# Prints the words of a target's language for libFuzzer's -dict. They come from the tables (`triptych list`)
# and from the repository's own files. Prints nothing for targets that read binary data.
#
#   COMMAND=build/triptych tests/command/fuzz/dictionary.sh TARGET
set -uo pipefail
cd "$(dirname "$0")/../../.."

# Prints the strings in the JSON of a list, except the descriptions.
listed() # WHAT
{
    "$COMMAND" list "$1" --json | grep -vE '"(meaning|test|keys|supported|kind|what)":' |
        grep -oE '"[^"]*"(,|$)' | grep -oE '[A-Za-z0-9_.+-]+'
}

# Prints the words of files of the language, without numbers.
used() # FILE...
{
    cat "$@" | sed 's/#.*//; s,//.*,,' | grep -oE '[A-Za-z_][A-Za-z0-9_]*(-[a-z]+)*' | sort | uniq -c |
        awk '$1 > 2 { print $2 }'
}

quoted() # words on standard input
{
    sort -u | sed 's/.*/"&"/'
}

shader_words() { { listed shaders && used $(find tests/data/shaders -type f); } | quoted; }

case $1 in
text)
    { listed states && listed formats && used tests/*/*.tri bench/streams/*.tri; } | quoted
    printf '%s\n' '"\x0a"' '" { "' '" }\x0a"' '"\x0atarget 16 16\x0a"' '"65536"' '"4294967295"' '"-1"' \
        '"1e39"' '"nan"' '"\x0arepeat 3 i\x0a"' '"\x0aend\x0a"' '"\x0alet a = "' '"(frame / count)"' '"(sin(i) * pi)"' \
        '" % "' '"sqrt("' '"floor("' '"round("' '"min(1, "' '"color(1, 0, 0, 1)"'
    ;;
shader) shader_words ;;
glsl | preprocess | program)
    { used tests/front/glsl/corpus/*.{vert,frag} && sed -n 's/^GLSL_KEYWORD("\([a-z]*[A-Za-z0-9]*\)".*/\1/p' src/front/glsl/compile/keyword.def; } | quoted
    printf '"%s"\n' '#if ' '#ifdef ' '#ifndef ' '#elif ' '#else\x0a' '#endif\x0a' '#define ' '#undef ' '#line ' '#error ' \
        '#extension ' ' : enable\x0a' '#version 100\x0a' '#pragma ' 'defined(' '__LINE__' '__FILE__' '__VERSION__' 'GL_ES' \
        '\x5c\x0a' '##' '/*' '*/' '&&' '<<' '!=' '0x7fffffff' '4294967295' '-1' '1e38' ;;
bezier) printf '"%s"\n' BBP STBBP BEZ333 CBEZ333 BEZ333_ST CBEZ333_ST 1e38 1e-45 0.5 -1 ;;
dds) listed formats | grep -E '^[A-Z0-9]{4}$' | quoted ;;
model) printf '"%s"\n' 'v ' 'vn ' 'vt ' 'f ' mtllib 'element vertex ' 'element face ' \
    'property list uchar int ' solid facet \
    vertex OFF Mesh Frame glTF accessors bufferViews byteLength COLLADA 4294967295 -1 1e38 nan ;;
png) printf '"%s"\n' IHDR PLTE IDAT IEND tRNS gAMA iCCP zTXt iTXt sPLT ;;
esac
