#!/usr/bin/env bash
# Usage: sudo ./docker/verify.sh [options]
#
# Builds the image without a container engine's daemon, from an empty cache, and proves it: the mission as a user who
# is not root, once more without network and with nothing writable but the run folder, an interrupted one, and the
# tests. Needs root, buildah, and debootstrap for the base.
# Exit code: 0 all proven, 1 failure, 2 bad usage.
#
#   --base TAR       root file system of Debian 12 to build on (default: made with debootstrap)
#   --tests WHAT     unit, ros, all or none, with names as for scripts/test.sh (default: all)
#   --work FOLDER    where images and results are kept (default: a temporary folder, deleted at the end)
#   --help           this text

set -euo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
readonly image=localhost/home-service-robot user=1000 certificates=/etc/ssl/certs/ca-certificates.crt
base='' tests=all work=''

say() { printf '\n== %d:%02d  %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$*"; } # with the time since the start

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
            --base | --tests | --work) (($# > 1)) || fail "$1 needs a value" 2 ;;&
            --base) base=$(readlink -f -- "$2") ;;
            --tests) tests=$2 ;;
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
    if [[ -z $work ]]; then
        work=$(mktemp -d)
        trap clean_up EXIT
    fi
    mkdir -p "$work/runs" "$work/storage" "$work/state"
    chown "$user:$user" "$work/runs"
}

clean_up() {
    builder umount --all >/dev/null 2>&1 || true
    builder rm --all >/dev/null 2>&1 || true
    rm -rf --one-file-system "$work"
}

builder() { buildah --root "$work/storage" --runroot "$work/state" "$@"; }

make_base() {
    if [[ -z $base ]]; then
        say "A root file system of Debian 12"
        debootstrap --variant=minbase bookworm "$work/base" 2>&1 | show '^I: (.* the base system|Base system)' \
            "$work/debootstrap.log" || fail "debootstrap failed (see $work/debootstrap.log)"
        rm -rf "$work"/base/var/cache/apt/*.bin "$work"/base/var/cache/apt/archives/*.deb
        base=$work/base
    fi
    local container
    container=$(builder from --pull-never scratch)
    builder add --quiet "$container" "$base" / >/dev/null
    builder commit --quiet --rm "$container" localhost/debian:bookworm-slim >/dev/null
}

build_image() {
    say "The image, from an empty cache"
    local options=(--isolation chroot --format docker --layers --no-cache --pull-never)
    if [[ -r $certificates ]]; then # pip trusts whom this machine trusts
        printf '[global]\ncert = /run/certificates.crt\n' >"$work/pip.conf"
        options+=(-v "$certificates:/run/certificates.crt:ro" -v "$work/pip.conf:/etc/pip.conf:ro")
    fi
    builder build "${options[@]}" --from localhost/debian:bookworm-slim \
        --file "$root/docker/Dockerfile" --tag "$image" "$root" 2>&1 |
        show 'STEP [0-9]|^  done in' "$work/build.log" || {
        tail -n 30 "$work/build.log" >&2
        fail "the build failed (see $work/build.log)"
    }
    builder images --format '{{.Name}} {{.Size}}' "$image"
    rootfs=$(builder mount "$(builder from --pull-never "$image")")
    mapfile -t environment < <(builder inspect --type image --format '{{range .OCIv1.Config.Env}}{{println .}}{{end}}' \
        "$image" | sed '/^$/d')
}

run_image() { # READ_ONLY ARGUMENT...: as `docker run --network none [--read-only] -v RUNS:/runs IMAGE ARGUMENT...`
    echo "127.0.0.1 localhost" >"$work/hosts"
    ROOTFS=$rootfs RUNS=$work/runs HOSTS=$work/hosts READ_ONLY=$1 OWNER=$user \
        unshare --mount --net --ipc --pid --fork --kill-child bash -s -- "${environment[@]}" -- "${@:2}" <<'SANDBOX'
set -e
variables=()
while [[ $1 != -- ]]; do variables+=("$1"); shift; done
shift
ip link set lo up
mount --bind "$ROOTFS" "$ROOTFS"
mount --rbind /dev "$ROOTFS/dev"
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
    say "$title"
    run_image "$@" || code=$?
    ((code == expected)) || fail "$title: exit code $code, not $expected"
    echo "exit code $code, as expected"
}

parse "$@"
check_tools
make_work_folder
make_base
build_image
expect 0 "The mission, as user $user, without network" no --seed 1 --gif
expect 0 "The mission with nothing writable but the run folder" yes home_service --seed 2
expect 2 "Bad input" yes home_service --world nowhere.world
expect 1 "A mission that takes too long" yes home_service --timeout 5
# shellcheck disable=SC2086 # WHAT may be several words
[[ $tests == none ]] || expect 0 "The tests, as user $user" no test $tests
say "What the runs left, and to whom it belongs"
ls -ln "$work"/runs/*/
say "All proven"
