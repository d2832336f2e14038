#!/bin/bash
# Prints a draw stream of lab 4:
#
#   streams.sh picture OPERATION [FORMAT]   256 x 256 pixels; pixel (a, b) shows OPERATION of a and b.
#                                           The target's format is FORMAT, by default A8R8G8B8.
#   streams.sh expected FORMULA             the same picture, as a texture whose texels FORMULA computes: an
#                                           expression of awk that reads a and b
#   streams.sh quad OPERATION               one draw with OPERATION, to look at its routine
set -euo pipefail

square()
{
    cat <<'END'
vertices square position:float2 diffuse:color texcoord:float2 {
    -1 -1   ffffffff   0 1
    -1  1   ffffffff   0 0
     1 -1   ffffffff   1 1
     1  1   ffffffff   1 0
}
state lighting false
state cullmode none
state zenable false
bind vertices square
END
}

# A texture of WIDTH x HEIGHT whose texels have FORMULA of their coordinates a and b in every channel.
texture() # WIDTH HEIGHT FORMULA
{
    echo "texture values $1 $2 {"
    awk "BEGIN { for (b = 0; b < $2; b++) { for (a = 0; a < $1; a++) { v = int($3); printf \" %02x%02x%02x%02x\", v, v, v, v }
        print \"\" } }"
    echo '}'
}

# The first argument is the texture, the second the constant of the stage.
operation()
{
    printf '%s\n' 'bind texture values' "stage 0 colorop $1" 'stage 0 colorarg1 texture' 'stage 0 colorarg2 tfactor' \
        "stage 0 alphaop $1" 'stage 0 alphaarg1 texture' \
        'stage 0 alphaarg2 tfactor'
}

echo 'triptych 1'
case ${1-} in
picture)
    echo "target 256 256 color ${3:-A8R8G8B8}"
    texture 256 1 a
    square
    operation "$2"
    for ((b = 0; b < 256; b++)); do
        printf 'viewport 0 %d 256 1 0 1\nstate texturefactor 0x%02x%02x%02x%02x\ndraw strip 0 2\n' $b $b $b $b $b
    done
    ;;
expected)
    echo 'target 256 256'
    texture 256 256 "$2"
    square
    operation selectarg1
    echo 'draw strip 0 2'
    ;;
quad)
    echo 'target 256 256'
    texture 256 1 a
    square
    operation "$2"
    echo 'draw strip 0 2'
    ;;
*)
    echo 'usage: streams.sh picture OPERATION [FORMAT] | expected FORMULA | quad OPERATION' >&2
    exit 2
    ;;
esac
echo frame
