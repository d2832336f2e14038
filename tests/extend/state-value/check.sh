#!/usr/bin/env bash
# The texture operation that change.patch adds, difference, gives |a - b| for colour and alpha, on targets of
# bytes and of binary32, and every engine draws it alike. The expected colours are computed here.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# stream NAME FORMAT OPERATION FACTOR CONSTANT: covers the target with the operation of two colours
stream()
{
    cat >"$work/$1.tri" <<END
triptych 1
target 16 16 color $2
vertices corners position:float3 {
    -1 -1 0
    -1  1 0
     1 -1 0
    -1  1 0
     1  1 0
     1 -1 0
}
clear color 0 0 0 0 depth 1
state lighting false
state cullmode none
state texturefactor $4
stage 0 constant $5
stage 0 colorop $3
stage 0 colorarg1 tfactor
stage 0 colorarg2 constant
stage 0 alphaop $3
stage 0 alphaarg1 tfactor
stage 0 alphaarg2 constant
bind vertices corners
draw triangles 0 2
END
    "$TRIPTYCH" render "$work/$1.tri" --out "$work/$1.png" >/dev/null
}

pairs=('0x80c02040 0x10ff8040' '0x00000000 0xffffffff' '0xff102030 0xff302010')
for format in A8R8G8B8 A32B32G32R32F; do
    for pair in "${pairs[@]}"; do
        read -r a b <<<"$pair"
        expected=0
        for shift in 0 8 16 24; do
            x=$((a >> shift & 255)) y=$((b >> shift & 255))
            ((expected |= (x > y ? x - y : y - x) << shift)) || true
        done
        stream difference "$format" difference "$a" "$b"
        stream expected "$format" selectarg1 "$(printf '0x%08x' "$expected")" 0
        "$TRIPTYCH" compare "$work/difference.png" "$work/expected.png" >/dev/null ||
            { echo "$format: the difference of $a and $b is not $(printf '0x%08x' "$expected")" >&2; exit 1; }
        "$TRIPTYCH" verify "$work/difference.tri" --threads 2
    done
done

# Random cases contain the new value without a change, and every engine agrees.
n=0
until "$TRIPTYCH" fuzz --print "$n" | grep -q 'op difference'; do ((++n < 1000)); done
"$TRIPTYCH" fuzz --first "$n" --count 1 --output "$work/findings" --threads 1
