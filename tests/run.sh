#!/bin/bash
# `triptych run` without Wine: its messages, and what a program that is named as Wine gets.
# Given BUILD, TRIPTYCH and SANITIZE by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
unset WINEPREFIX WINEDLLPATH WINEDLLOVERRIDES WINEDEBUG TRIPTYCH_ENGINE TRIPTYCH_THREADS TRIPTYCH_RECORD

# A command with files of Direct3D 9 beside it, as after `make d3d9`, and one without.
mkdir -p "$work/build/d3d9/x86_64-windows" "$work/build/d3d9/x86_64-unix" "$work/bare" "$work/usr/bin" "$work/usr/lib/triptych"
for folder in build bare usr/bin; do cp "$TRIPTYCH" "$work/$folder/triptych"; done
for folder in build bare usr/bin; do cp "$(dirname "$TRIPTYCH")"/tests/shared.so "$work/$folder/" 2>/dev/null; done
echo one >"$work/build/d3d9/x86_64-windows/d3d9.dll"
echo two >"$work/build/d3d9/x86_64-windows/triptych9.dll"
echo three >"$work/build/d3d9/x86_64-unix/triptych9.so"
cp -r "$work/build/d3d9" "$work/usr/lib/triptych/d3d9"
printf MZ >"$work/program.exe"

# A Wine that makes a prefix, and prints its arguments and environment.
cat >"$work/wine" <<'END'
#!/bin/sh
if [ "$1" = wineboot ]; then
    echo "$WINEDLLOVERRIDES" >"$0.boot"
    [ -f "$0.broken" ] && exit 3
    mkdir -p "$WINEPREFIX/drive_c/windows/system32" && echo original >"$WINEPREFIX/drive_c/windows/system32/d3d9.dll"
    exit
fi
for argument; do echo "argument $argument"; done
env | grep -E '^(WINE|TRIPTYCH)' | sort
exit 7
END
chmod +x "$work/wine"

verdict() # NAME PROBLEM : ok when there is none
{
    if [[ -z $2 ]]; then
        printf 'ok %s\n' "$1"
    else
        printf 'FAIL %s\n     %s\n' "$1" "$2"
        sed 's/^/     output: /' "$work/said" | head -n 12
        sed 's/^/     stderr: /' "$work/err" | head -n 5
        failures=1
    fi
}

call() # COMMAND ARGUMENT... : triptych run with this Wine, in $work
{
    local command=$1
    shift
    (cd "$work" && timeout 60 "./$command/triptych" run "$@") >"$work/said" 2>"$work/err" </dev/null
}

# Exit status 2, nothing on stdout, one line on stderr that matches.
refuses() # NAME PATTERN COMMAND ARGUMENT...
{
    local name=$1 pattern=$2 status=0 problem=
    shift 2
    call "$@" || status=$?
    if ((status != 2)); then
        problem="exit status $status, expected 2"
    elif [[ -s $work/said ]] || (($(wc -l <"$work/err") != 1)); then
        problem='expected one line, on stderr'
    elif ! grep -qE -- "$pattern" "$work/err"; then
        problem="stderr without \"$pattern\""
    fi
    verdict "$name" "$problem"
}

# The fake Wine runs: its exit status is 7.
starts() # NAME COMMAND ARGUMENT...
{
    local name=$1 status=0
    shift
    call "$@" || status=$?
    ((status == 7))
    verdict "$name" "$( ((status == 7)) || echo "exit status $status, expected 7")"
}

prints() # NAME LINE... : the last output has these lines
{
    local name=$1 line problem=
    shift
    for line; do grep -qxF -- "$line" "$work/said" || problem+="no line \"$line\" "; done
    verdict "$name" "$problem"
}

holds() # NAME COMMAND...
{
    local name=$1
    shift
    "$@"
    verdict "$name" "$( (($? == 0)) || echo "failed: $*")"
}

refuses 'a program is necessary' 'expected PROGRAM' build
refuses 'a missing program is named' '^triptych run: ./none.exe: not found, expected a program in PATH or a file$' \
    build --wine ./wine --prefix p ./none.exe
refuses 'without Wine its package is named' 'nowine: not found, expected Wine.*wine64' build --wine nowine program.exe
missing='^triptych run: nosuchprogram: not found, expected a program in PATH or a file$'
for command in build bare; do
    refuses "a name that neither PATH nor the folder has is named, $command" "$missing" $command --wine nowine nosuchprogram
    refuses "the same with Wine, $command" "$missing" $command --wine ./wine --prefix p nosuchprogram
    refuses "the same for a program of Linux, $command" "$missing" $command --gl nosuchprogram
    refuses "a text is not a program, $command" '/etc/passwd: is not a program, expected an ELF file, a script or a file that' \
        $command --wine ./wine --prefix p /etc/passwd
done
holds 'no prefix was made for them' test ! -e "$work/p"
refuses 'a folder is not a program' '/etc: not found, expected a program' build --wine ./wine --prefix p /etc
refuses 'a program of Windows is not one of Linux' 'program.exe: found a program of Windows, expected one of Linux for --gl' \
    build --gl program.exe
cp "$work/program.exe" "$work/copy.exe"
refuses 'a recording does not replace the program' '--record is "copy.exe", the file of PROGRAM, expected another' \
    build --wine ./wine --record copy.exe copy.exe
refuses 'files that are not built are named' 'bare/d3d9 has no files, expected those that `make d3d9` makes' \
    bare --wine ./wine --prefix p program.exe
refuses 'an unknown engine gets a suggestion' 'did you mean "emulate"' build --engine emulat --wine ./wine program.exe
refuses 'a number of threads has bounds' '--threads is "0", expected a whole number from 1' build --threads 0 program.exe
refuses 'a recording that cannot be written is refused' 'none/a.trib' build --wine ./wine --record none/a.trib program.exe
refuses 'a recording needs a file' '--record is "-", expected a file' build --wine ./wine --record - program.exe
: >"$work/wine.broken"
refuses 'a prefix that cannot be made is an error' 'p: .*wineboot -i. failed' build --wine ./wine --prefix p program.exe 2>/dev/null
rm "$work/wine.broken"

starts 'the program is started' build --engine emulate --threads 2 --record r.trib --prefix p --wine ./wine program.exe --level 3 -- -x
prints 'all that follows the program is for the program' 'argument program.exe' 'argument --level' 'argument 3' \
    'argument --' 'argument -x'
prints 'Wine gets its environment' "WINEPREFIX=$work/p" "WINEDLLPATH=$work/build/d3d9" WINEDLLOVERRIDES=d3d9=n \
    WINEDEBUG=-all TRIPTYCH_ENGINE=emulate TRIPTYCH_THREADS=2 "TRIPTYCH_RECORD=$work/r.trib"
holds 'a line reports that nothing was recorded' grep -qx \
    "triptych run: $work/r.trib: nothing was recorded, because ./wine has drawn nothing with Triptych" "$work/err"
holds 'and nothing else is on standard error' test "$(wc -l <"$work/err")" = 1
holds 'the prefix was made without questions' grep -qx 'mscoree=;mshtml=' "$work/wine.boot"
holds 'the prefix has the DLLs' cmp "$work/build/d3d9/x86_64-windows/triptych9.dll" "$work/p/drive_c/windows/system32/triptych9.dll"
holds 'they replace those of Wine' cmp "$work/build/d3d9/x86_64-windows/d3d9.dll" "$work/p/drive_c/windows/system32/d3d9.dll"

: >"$work/p/drive_c/windows/system32/Notepad.exe"
for name in notepad notepad.exe; do
    starts "a program of the prefix is found, $name" build --prefix p --wine ./wine $name
    prints 'Wine gets its name' "argument $name"
done
refuses 'a program that the prefix has not' 'notepad2.exe: not found, expected a program in PATH or a file' \
    build --prefix p --wine ./wine notepad2.exe
refuses 'a program that a new prefix has not' 'notepad2.exe: not found, expected a program in PATH or a file' \
    build --prefix new --wine ./wine notepad2.exe
starts 'a path of Windows is for Wine' build --prefix p --wine ./wine 'C:\windows\notepad.exe'
starts 'the name of a file may lack its .exe' build --prefix p --wine ./wine program
prints 'Wine gets the path of the file' 'argument program.exe'

mkdir -p "$work/build/d3d9/i386-windows" "$work/p/drive_c/windows/syswow64"
echo narrow >"$work/build/d3d9/i386-windows/d3d9.dll"
echo narrow >"$work/build/d3d9/i386-windows/triptych9.dll"
starts 'a prefix for programs of 64 and 32 bits is used' build --prefix p --wine ./wine program.exe
holds 'programs of 32 bits have DLLs of their own' grep -qx narrow "$work/p/drive_c/windows/syswow64/d3d9.dll"
holds 'those of 64 bits are the same' grep -qx one "$work/p/drive_c/windows/system32/d3d9.dll"
mkdir -p "$work/old/drive_c/windows/system32"
printf 'WINE REGISTRY Version 2\n\n#arch=win32\n' >"$work/old/system.reg"
starts 'a prefix for programs of 32 bits is used' build --prefix old --wine ./wine program.exe
holds 'it has the DLLs of 32 bits' grep -qx narrow "$work/old/drive_c/windows/system32/d3d9.dll"
refuses 'a prefix of 32 bits needs files of 32 bits' 'old: has only programs of 32 bits, expected i386-windows' \
    usr/bin --prefix old --wine ./wine program.exe

rm "$work/wine.boot"
echo newer >"$work/build/d3d9/x86_64-windows/triptych9.dll"
export WINEPREFIX=$work/p WINEDLLPATH=/there WINEDLLOVERRIDES='a=n;d3d9=b' WINEDEBUG=+loaddll
starts 'a prefix is used again' build --wine ./wine program.exe
prints 'the environment of the user stays' "WINEPREFIX=$work/p" "WINEDLLPATH=$work/build/d3d9:/there" \
    'WINEDLLOVERRIDES=a=n;d3d9=b;d3d9=n' WINEDEBUG=+loaddll
holds 'an existing prefix is not made again' test ! -e "$work/wine.boot"
holds 'newer DLLs replace older ones' grep -qx newer "$work/p/drive_c/windows/system32/triptych9.dll"
holds 'no engine is the default of the library' bash -c "! grep -q ^TRIPTYCH_ENGINE '$work/said'"

echo precious >"$work/precious"
ln -sf "$work/precious" "$work/p/drive_c/windows/system32/d3d9.dll"
starts 'a link in the prefix is replaced' build --wine ./wine program.exe
holds 'what it names is not' grep -qx precious "$work/precious"

starts 'installed files are found' usr/bin --wine ./wine program.exe
prints 'their folder is that of make install' "WINEDLLPATH=$work/usr/bin/../lib/triptych/d3d9:/there"
exit $failures
