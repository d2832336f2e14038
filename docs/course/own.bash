# For labs whose folder has sources of Triptych, in src/: a command with these files instead of the project's. They
# are headers, tables and C files.
# A check sources this file after course.bash.
#
# Such a lab has a file `sources` with the paths of these files. lab.sh copies them when it makes the folder, and
# applies `start.patch` if the lab has one.

# Prints the objects of the project's build, relative to BUILD, that include a file of the folder's src/.
own_objects()
{
    local own object
    own=$(find src -type f)
    for object in $(<"$BUILD/library.list") $(<"$BUILD/command.list"); do
        [[ ! -f $BUILD/${object%.o}.d ]] || ! grep -qF -- "$own" "$BUILD/${object%.o}.d" || echo "$object"
    done
}

# Compiles one object. Optimising the whole specification takes long, so only the emulator is optimised, and only
# if a lab measures it.
own_compile() # OBJECT
{
    local object=$1 source=${1#object/} level=-O0
    source=${source%.o}.c
    [[ ! -f $OWN/$source ]] || source=$OWN/$source
    [[ $object != */emulate/typed_each.o ]] || level=${EMULATOR:--O0}
    mkdir -p "$WORK/$(dirname "$object")"
    cd "$ROOT" || return 1
    nice "$CC" -std=gnu17 $level -g -Wall -Wextra -Werror -ffp-contract=off -fPIC -fvisibility=hidden -pthread \
        -I"$OWN/src" -Isrc -I. -I"$BUILD/include" -c "$source" -o "$WORK/$object"
}

# Links the command: each object of the student's, or else the project's; the libraries of the project's command.
own_link()
{
    local object objects=() libraries
    for object in $(<"$BUILD/library.list") $(<"$BUILD/command.list"); do
        if [[ -f $WORK/$object ]]; then objects+=("$WORK/$object"); else objects+=("$BUILD/$object"); fi
    done
    libraries=$(readelf -d "$BUILD/triptych" | sed -n 's/.*(NEEDED).*\[\(lib[^]]*\)\]/-l:\1/p')
    "$CC" -pthread -Wl,-z,noexecstack -o "$WORK/triptych" "${objects[@]}" $libraries
}

# Makes WORK/triptych, if a file has changed since. OWN_MORE: objects that are compiled too, although they include
# none of the files; without optimisation a debugger shows all of their lines.
own_triptych()
{
    local digest
    [[ -d src ]] || { echo 'expected the folder src: begin with an empty folder' && return 1; }
    digest=$(find src -type f -exec cat {} + | cat - "$BUILD/triptych" | cksum)
    [[ ! -x $WORK/triptych || $(cat "$WORK/digest" 2>/dev/null) != "$digest" ]] || return 0
    rm -rf "$WORK/object" "$WORK/triptych"
    export OWN=$PWD EMULATOR=${EMULATOR:--O0}
    export -f own_compile
    { own_objects && printf '%s\n' ${OWN_MORE-}; } | xargs -r -P "$(nproc)" -I{} bash -c 'own_compile {}' &&
        own_link && echo "$digest" >"$WORK/digest"
}
