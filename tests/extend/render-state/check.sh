#!/usr/bin/env bash
# The state that change.patch adds, depthclipenable, takes effect and every engine draws it alike. A triangle
# that crosses the near and the far plane is cut where the state is true, which is its default. Where it is
# false, the triangle covers the same pixels as one that lies between the planes.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# stream NAME DEPTHS STATE: a triangle whose corners have these depths
stream()
{
    read -r a b c <<<"$2"
    cat >"$work/$1.tri" <<END
triptych 1
target 64 64
vertices corners position:float3 {
    -0.75 -0.75 $a
     0     0.75 $b
     0.75 -0.75 $c
}
clear color 0 0 0 1 depth 1
state lighting false
state cullmode none
state zfunc lessequal
state depthclipenable $3
bind vertices corners
draw triangles 0 1
END
    "$TRIPTYCH" render "$work/$1.tri" --out "$work/$1.png" >/dev/null
}

stream inside '0.5 0.5 0.5' true
stream cut '-1 0.5 2' true
stream whole '-1 0.5 2' false
"$TRIPTYCH" compare "$work/inside.png" "$work/whole.png" >/dev/null
if "$TRIPTYCH" compare "$work/inside.png" "$work/cut.png" >/dev/null; then
    echo 'depthclipenable true does not cut the triangle' >&2
    exit 1
fi
"$TRIPTYCH" verify "$work/cut.tri" "$work/whole.tri" --threads 2
