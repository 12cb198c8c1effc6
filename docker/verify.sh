#!/usr/bin/env bash
# Usage: sudo ./docker/verify.sh [options]
#
# Builds the image without a container engine's daemon, from an empty cache, and tests it: the mission as a user who
# is not root, once more without network and with nothing writable but the run folder, an interrupted one, and the
# tests. Needs root, buildah, and debootstrap for the base. Takes half an hour; prints each step with the elapsed time.
# Exit code: 0 all passed, 1 failure, 2 bad usage.
#
#   --base TAR       root file system of Debian 13 to build on (default: made with debootstrap)
#   --ros-tests NAMES
#                    besides the unit tests, the ROS tests whose paths contain one of the names (default: all)
#   --rviz           also the target with rviz: a mission shown on the display
#   --work FOLDER    where images and results are kept (default: a temporary folder, deleted at the end)
#   --help           this text

set -euo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
readonly name=home-service-robot user=1000 certificates=/etc/ssl/certs/ca-certificates.crt
base='' ros_tests='' rviz='' work=''

print_line() { printf '\n== %d:%02d  %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$*"; } # with the time since the start

show() { # PATTERN LOG: of what is read, the lines that match, with the time since the start; all of it goes to LOG
    local line
    while IFS= read -r line; do
        if [[ $line =~ $1 ]]; then printf '   %d:%02d  %.100s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$line"; fi
        printf '%s\n' "$line" >>"$2"
    done
}

fail() { # SENTENCE [EXIT_CODE]
    printf 'error: %s\n' "$1" >&2
    exit "${2:-1}"
}

usage() { sed -n '2,/^$/ s/^# \{0,1\}//p' "$0"; }

parse() {
    while (($#)); do
        case $1 in
            --help | -h) usage && exit 0 ;;
            --rviz)
                [[ -n ${DISPLAY:-} ]] || fail "--rviz needs a display" 2
                rviz=yes
                shift
                continue
                ;;
            --base | --ros-tests | --work) (($# > 1)) || fail "$1 needs a value" 2 ;;&
            --base) base=$(readlink -f -- "$2") ;;
            --ros-tests) ros_tests=$2 ;;
            --work) work=$(readlink -m -- "$2") ;;
            *) fail "unknown option '$1'" 2 ;;
        esac
        shift 2
    done
    [[ -z $base || -r $base ]] || fail "$base: no such file" 2
}

check_tools() {
    ((EUID == 0)) || fail "this needs root: it mounts and changes roots" 2
    local tool
    for tool in buildah unshare ${base:-debootstrap}; do
        [[ $tool == "$base" ]] || command -v "$tool" >/dev/null || fail "$tool is not installed" 2
    done
}

make_work_folder() {
    is_kept=$work
    work=${work:-$(mktemp -d)}
    trap clean_up EXIT
    mkdir -p "$work/runs" "$work/storage" "$work/state"
    chown "$user:$user" "$work/runs"
}

clean_up() {
    builder umount --all >/dev/null 2>&1 || true
    builder rm --all >/dev/null 2>&1 || true
    [[ -n $is_kept ]] || rm -rf --one-file-system "$work"
}

builder() { buildah --root "$work/storage" --runroot "$work/state" "$@"; }

make_base() {
    if [[ -z $base ]]; then
        print_line "A root file system of Debian 13"
        debootstrap --variant=minbase trixie "$work/base" 2>&1 | show '^I: (.* the base system|Base system)' \
            "$work/debootstrap.log" || fail "debootstrap failed (see $work/debootstrap.log)"
        # As the image of that name: without manuals and translations.
        (cd "$work/base" && rm -rf var/cache/apt/*.bin var/cache/apt/archives/*.deb usr/share/{man,locale,info} \
            && find usr/share/doc -type f ! -name copyright -delete)
        base=$work/base
    fi
    local container
    container=$(builder from --pull-never scratch)
    builder add --quiet "$container" "$base" / >/dev/null
    builder commit --quiet --rm "$container" localhost/debian:trixie-slim >/dev/null
}

build_image() { # NAME OPTION...: builds an image and mounts it as $rootfs
    local image=localhost/$1 options=(--isolation chroot --format docker --layers --pull-never "${@:2}")
    if [[ -r $certificates ]]; then # pip trusts whom this machine trusts
        printf '[global]\ncert = /run/certificates.crt\n' >"$work/pip.conf"
        options+=(-v "$certificates:/run/certificates.crt:ro" -v "$work/pip.conf:/etc/pip.conf:ro")
    fi
    builder build "${options[@]}" --from localhost/debian:trixie-slim \
        --file "$root/docker/Dockerfile" --tag "$image" "$root" 2>&1 |
        show 'STEP [0-9]|^  done in' "$work/build.log" || {
        tail -n 30 "$work/build.log" >&2
        fail "the build failed (see $work/build.log)"
    }
    builder images --format '{{.Name}}:{{.Tag}} {{.Size}}' "$image"
    rootfs=$(builder mount "$(builder from --pull-never "$image")")
    mapfile -t environment < <(builder inspect --type image --format '{{range .OCIv1.Config.Env}}{{println .}}{{end}}' \
        "$image" | sed '/^$/d')
}

run_image() { # READ_ONLY ARGUMENT...: as `docker run --network none [--read-only] -v RUNS:/runs IMAGE ARGUMENT...`
    echo "127.0.0.1 localhost" >"$work/hosts"
    ROOTFS=$rootfs RUNS=$work/runs HOSTS=$work/hosts READ_ONLY=$1 OWNER=$user DISPLAY=${rviz:+$DISPLAY} \
        unshare --mount --net --ipc --pid --fork --kill-child bash -s -- "${environment[@]}" -- "${@:2}" <<'SANDBOX'
set -e
variables=()
while [[ $1 != -- ]]; do variables+=("$1"); shift; done
shift
ip link set lo up
mount --bind "$ROOTFS" "$ROOTFS"
mount --rbind /dev "$ROOTFS/dev"
if [[ -n $DISPLAY ]]; then
    mkdir -p "$ROOTFS/tmp/.X11-unix"
    mount --bind /tmp/.X11-unix "$ROOTFS/tmp/.X11-unix"
fi
mount -t proc proc "$ROOTFS/proc"
mount --bind "$RUNS" "$ROOTFS/runs"
touch "$ROOTFS/etc/hosts"
mount --bind "$HOSTS" "$ROOTFS/etc/hosts"
[[ $READ_ONLY == no ]] || mount -o remount,bind,ro "$ROOTFS"
exec chroot --userspec="$OWNER:$OWNER" "$ROOTFS" env -i "${variables[@]}" \
    /opt/home-service-robot/docker/entrypoint.sh "$@" </dev/null
SANDBOX
}

expect() { # EXIT_CODE TITLE READ_ONLY ARGUMENT...
    local expected=$1 title=$2 code=0
    shift 2
    print_line "$title"
    run_image "$@" || code=$?
    ((code == expected)) || fail "$title: exit code $code, not $expected"
    echo "exit code $code, as expected"
}

parse "$@"
check_tools
make_work_folder
make_base
print_line "The image, from an empty cache"
build_image "$name" --no-cache
expect 0 "The mission, as user $user, without network" no --seed 1 --gif
expect 0 "The mission with nothing writable but the run folder" yes home_service --seed 2
expect 2 "Bad input" yes home_service --world nowhere.world
expect 1 "A mission that takes too long" yes home_service --timeout 5
expect 0 "The unit tests, as user $user" no test unit
# shellcheck disable=SC2086 # NAMES may be several
expect 0 "The ROS tests, as user $user" no test ros $ros_tests
if [[ -n $rviz ]]; then
    print_line "The image with rviz"
    build_image "$name:rviz" --target rviz
    environment+=("DISPLAY=$DISPLAY" LIBGL_ALWAYS_SOFTWARE=1)
    expect 0 "The mission, shown in rviz" yes home_service --rviz
fi
print_line "What the runs left, and to whom it belongs"
ls -ln "$work"/runs/*/
print_line "All passed"
