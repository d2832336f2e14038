#!/bin/bash
# A desktop for Windows programs: an X server without a screen, a window manager and a prefix of Wine, all of
# its own. Sourced by scripts; the caller's exit trap calls desktop_end.
#
#   desktop_begin FOLDER [modes]   the prefix is FOLDER/prefix, made at first use. The screen has 1024x768
#                                  pixels, by Xvfb; with "modes" it is Xorg's dummy driver, which has further
#                                  display modes, and fvwm3 manages the windows
#   desktop_reset                  ends the programs of the prefix and restores the display mode
#   desktop_end                    ends the server, the manager and the programs of the prefix
#
# Sets DISPLAY, WINEPREFIX, WINEARCH, WINEDEBUG and what makes OpenGL draw on the processor.

desktop_processes=()

# Xorg's dummy driver has several display modes, which Xvfb does not have: programs can change the mode.
desktop_modes()
{
    cat <<'CONFIGURATION'
Section "ServerFlags"
    Option "AutoAddDevices" "false"
    Option "AutoAddGPU" "false"
    Option "DontVTSwitch" "true"
    Option "BlankTime" "0"
EndSection
Section "Device"
    Identifier "card"
    Driver "dummy"
    VideoRam 65536
EndSection
Section "Monitor"
    Identifier "monitor"
    HorizSync 5.0 - 1000.0
    VertRefresh 5.0 - 200.0
EndSection
Section "Screen"
    Identifier "screen"
    Device "card"
    Monitor "monitor"
    DefaultDepth 24
    SubSection "Display"
        Depth 24
        Modes "1024x768" "800x600" "640x480"
        Virtual 1024 768
    EndSubSection
EndSection
CONFIGURATION
}

desktop_server() # [modes]
{
    local number=$desktop_folder/display
    : >"$number"
    # The server chooses a free number and writes it.
    if [[ ${1-} == modes ]]; then
        desktop_modes >"$desktop_folder/xorg.conf"
        Xorg -displayfd 3 -config "$desktop_folder/xorg.conf" -logfile "$desktop_folder/xorg.log" -nolisten tcp \
            -noreset -novtswitch -sharevts 3>"$number" >/dev/null 2>&1 &
    else
        Xvfb -displayfd 3 -screen 0 1024x768x24 -nolisten tcp -noreset 3>"$number" >/dev/null 2>&1 &
    fi
    desktop_processes+=($!)
    for _ in {1..100}; do
        [[ ! -s $number ]] || break
        sleep 0.1
    done
    [[ -s $number ]] || { echo 'desktop: the X server does not start' >&2 && return 1; }
    DISPLAY=:$(<"$number")
    export DISPLAY
}

# Windows get the decorations and the places that programs request. The focus does not follow the pointer, as
# in Windows.
desktop_manager()
{
    printf '%s\n' 'Style * MwmDecor' 'Style * UsePPosition' 'Style * !MinOverlapPlacement' \
        'Style * ClickToFocus' >"$desktop_folder/fvwm"
    fvwm3 -f "$desktop_folder/fvwm" >/dev/null 2>&1 &
    desktop_processes+=($!)
}

# Wine's own warnings are off: the programs' output is read by scripts.
desktop_begin()
{
    desktop_folder=$(mkdir -p "$1" && cd "$1" && pwd)
    desktop_server "${2-}" || return 1
    export WINEPREFIX=$desktop_folder/prefix WINEARCH=win64 WINEDEBUG=${WINEDEBUG:--all} LIBGL_ALWAYS_SOFTWARE=1
    [[ ${2-} != modes ]] || desktop_manager
    # Programs of the prefix need neither .NET nor HTML, whose installers would open windows.
    if [[ ! -f $WINEPREFIX/system.reg ]]; then
        WINEDLLOVERRIDES='mscoree=;mshtml=' wineboot -i >/dev/null 2>&1 || return 1
        wineserver -w
    fi
}

desktop_reset()
{
    wineserver -k 2>/dev/null || true
    wineserver -w 2>/dev/null || true
    xrandr -s 1024x768 2>/dev/null || true
}

desktop_end()
{
    [[ -z ${desktop_folder-} ]] || wineserver -k 2>/dev/null || true
    ((${#desktop_processes[@]} == 0)) || kill "${desktop_processes[@]}" 2>/dev/null || true
    wait "${desktop_processes[@]}" 2>/dev/null || true
}
