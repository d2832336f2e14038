#!/bin/bash
# The measurements of `make peers`: Triptych's engines and other renderers on the same work, in turns.
#
#   bench/peers.sh [OPTION of bench/peers/drive.c]...
#
# In the environment:
#   WORKLOAD=glob     the workloads (bench/peers/workload.def). Default: all
#   PEERS="name..."   the renderers and engines, by glob; the suffix -all means on all cores. Default:
#                     softpipe, llvmpipe, llvmpipe-newest, swiftshader, swgl and swgl-span, emulate, batch,
#                     stitch, specialize, and on all cores llvmpipe, swiftshader, stitch, specialize.
#                     NAME=COMMAND is your program with the protocol of peer.h (spaces as commas).
#   PASSES=n          the number of passes. Default: 5
#   CLOCK=time        wall time for the renderers on one core. Default: processor time, which other processes
#                     disturb less
#   PRIORITY=1        real-time priority of the renderers (chrt -f), on a machine whose other processes can
#                     wait
#   QUICK=1           one pass of short samples
#   SWGL=program      the program that bench/swgl.sh builds
#   MESA=dir          the folder of bench/mesa.sh, for llvmpipe-newest. Default: build/mesa
#   SWIFTSHADER=dir   the folder of ANGLE's libEGL.so and libGLESv2.so, with libvk_swiftshader.so
#   REPORT=name       the name of the report. Default: peers; peers-avx2 on a processor without AVX-512, so
#                     that its figures do not replace those of a processor that has it
#
# Writes results/peers.txt, .json and .svg (RESULTS, REPORT). Ends with 1 if a picture differs or a renderer
# failed, and lists the missing renderers. The suffix -avx2 of an engine hides AVX-512 from it.
set -euo pipefail
cd "$(dirname "$0")/.."

build=${BUILD:-build}
results=${RESULTS:-results}
report=peers narrow=specialize-avx2
"$build/triptych" list cpu | grep -q '^avx512f *yes' || report=peers-avx2 narrow=
report=$results/${REPORT:-$report}
mkdir -p "$results" "$build/peers"
cores=$(nproc)
wanted=(${PEERS:-softpipe llvmpipe llvmpipe-newest swiftshader swgl swgl-span emulate batch stitch specialize $narrow
    llvmpipe-all swiftshader-all stitch-all specialize-all})
engines=$("$build/triptych" list engines | awk 'NR > 1 && $3 == "available" { print $1 }')

# Pages as arrays, for the renderers that do not read streams.
export PAGES=$build/peers/pages
mkdir -p "$PAGES"
for page in bench/streams/pages/page-{text,subpixel,gallery,cards,list,map}.trib; do
    name=$(basename "$page" .trib)
    "$build/triptych" convert "$page" "$PAGES/$name.tri"
    python3 bench/peers/gles/page.py "$PAGES/$name.tri" "$PAGES/$name.page"
done

nice=${PRIORITY:+chrt -f $PRIORITY }
mesa=(env EGL_PLATFORM=surfaceless LIBGL_ALWAYS_SOFTWARE=1 MESA_SHADER_CACHE_DISABLE=true \
    __EGL_VENDOR_LIBRARY_FILENAMES=)
for file in /usr/share/glvnd/egl_vendor.d/*mesa*.json; do
    [[ -f $file ]] && mesa[-1]=__EGL_VENDOR_LIBRARY_FILENAMES=$file
done

# The first folder with all that ANGLE needs.
swiftshader=
for folder in ${SWIFTSHADER-} build/swiftshader /usr/lib/chromium /opt/google/chrome; do
    # Stubs of these libraries are smaller.
    if [[ -z $swiftshader && -s $folder/libEGL.so && -s $folder/libvk_swiftshader.so &&
        $(stat -c %s "$folder/libGLESv2.so" 2>/dev/null || echo 0) -gt 1000000 ]]; then
        swiftshader=$(realpath "$folder")
    fi
done

swgl=${SWGL:-build/swgl/renderer}
newest=${MESA:-build/mesa}

renderer() # NAME one|all : prints the renderer's line for the driver
{
    local threads=1
    [[ $2 == one ]] || threads=$cores
    case $1 in
        softpipe) echo "$1 peer $2 $nice${mesa[*]} GALLIUM_DRIVER=softpipe $build/peers/gles softpipe" ;;
        # With 0 threads, llvmpipe draws on the thread that calls it.
        llvmpipe)
            [[ $2 == one ]] && threads=0
            echo "$1 peer $2 $nice${mesa[*]} GALLIUM_DRIVER=llvmpipe LP_NUM_THREADS=$threads $build/peers/gles llvmpipe"
            ;;
        llvmpipe-newest)
            [[ $2 == one ]] && threads=0
            if [[ -x $newest/run ]]; then
                echo "$1 peer $2 $nice${mesa[*]} GALLIUM_DRIVER=llvmpipe LP_NUM_THREADS=$threads" \
                    "$(realpath "$newest")/run $build/peers/gles $1"
            else
                echo "$1 peer $2 missing no build/mesa/run (bench/mesa.sh fetches it) and no MESA"
            fi
            ;;
        swiftshader)
            if [[ $swiftshader ]]; then
                echo "$1 peer $2 ${nice}env LD_LIBRARY_PATH=$swiftshader" \
                    "VK_ICD_FILENAMES=$swiftshader/vk_swiftshader_icd.json $build/peers/gles swiftshader $swiftshader"
            else
                echo "$1 peer $2 missing no ANGLE with SwiftShader in build/swiftshader (bench/swiftshader.sh fetches it) or" \
                    "SWIFTSHADER"
            fi
            ;;
        swgl | swgl-span)
            local path=generic
            [[ $1 == swgl ]] || path=span
            if [[ -x $swgl ]]; then
                echo "$1 special $2 $nice$swgl $path"
            else
                echo "$1 special $2 missing no build/swgl/renderer (bench/swgl.sh builds it) and no SWGL"
            fi
            ;;
        *)
            local engine=${1%-avx2} features=
            [[ $engine == "$1" ]] || features='env TRIPTYCH_CPU=-avx512f '
            if grep -qx "$engine" <<<"$engines"; then
                echo "$1 engine $2 $nice$features$build/peers/triptych $engine $threads bench/streams/micro"
            else
                echo "$1 engine $2 missing no engine of that name runs here"
            fi
            ;;
    esac
}

renderers()
{
    local name known
    known="softpipe llvmpipe llvmpipe-newest swiftshader swgl swgl-span $engines specialize-avx2"
    for name in "${wanted[@]}"; do
        if [[ $name == *=* ]]; then
            local command=${name#*=}
            echo "${name%%=*} peer one ${command//,/ }"
            continue
        fi
        local where=one base=$name match found=
        [[ $name == *-all ]] && where=all base=${name%-all}
        for match in $known; do
            # shellcheck disable=SC2053
            if [[ $match == $base ]]; then renderer "$match" "$where" && found=1; fi
        done
        [[ $found ]] || renderer "$base" "$where"
    done
}

options=()
[[ -z ${WORKLOAD-} ]] || options+=(--workload "$WORKLOAD")
[[ -z ${QUICK-} ]] || options+=(--passes 1 --seconds 0.04 --budget 0)
[[ -z ${PASSES-} ]] || options+=(--passes "$PASSES")
[[ -z ${CLOCK-} ]] || options+=(--clock "$CLOCK")

status=0
renderers | "$build/peers/drive" --folder "$build/peers" --text "$report.txt" --json "$report.json" \
    --csv "$build/peers/chart.csv" "${options[@]}" "$@" || status=$?
if ((status < 2)) && [[ $(wc -l <"$build/peers/chart.csv") -gt 1 ]]; then
    gnuplot -c bench/peers/chart.gnuplot "$build/peers/chart.csv" "$report.svg" "$report.png" \
        "times the speed of llvmpipe, one core"
fi
exit "$status"
