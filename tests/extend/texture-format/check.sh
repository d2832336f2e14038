#!/usr/bin/env bash
# The format that change.patch adds, B2G3R3, is sampled, and every engine draws it alike. Its texels give the
# same picture as the same colours in R3G3B2, whose channels lie in the opposite order.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# stream FORMAT BYTES: a quad with a texture of 4x2 texels
stream()
{
    cat >"$work/$1.tri" <<END
triptych 1
target 64 64
vertices quad position:float3 texcoord:float2 {
    -0.9  0.9 0.5  0 0
     0.9  0.9 0.5  1 0
    -0.9 -0.9 0.5  0 1
     0.9 -0.9 0.5  1 1
}
texture colors 2d $1 4 2 bytes { $2 }
clear color 0.25 0.25 0.25 1 depth 1
state lighting false
state cullmode none
stage 0 colorop selectarg1
sampler 0 magfilter linear
bind vertices quad
bind texture colors
draw strip 0 2
END
    "$TRIPTYCH" render "$work/$1.tri" --out "$work/$1.png" >/dev/null
}

# red, green, blue, white; black, 5 2 1, 2 5 2, 7 0 3
stream R3G3B2 'e0 1c 03 ff 00 a9 56 e3'
stream B2G3R3 '07 38 c0 ff 00 55 aa c7'
"$TRIPTYCH" compare "$work/R3G3B2.png" "$work/B2G3R3.png" >/dev/null
"$TRIPTYCH" verify "$work/B2G3R3.tri" --threads 2
