# shellcheck shell=bash disable=SC2154,SC2034 # variables of lib.sh and setup.sh
# Checks of this machine and folder before anything is changed, and the summary of a log in one sentence.

readonly supported="Debian 11, 12 or 13, Ubuntu 22.04, or Ubuntu 20.04 with ROS Noetic in $noetic"

os_release=/etc/os-release

check_place() {
    local refused='[][:space:]"$;:\*?<>|!{}`&()#'"'[]"
    if [[ $root =~ $refused ]]; then
        fail "catkin cannot build in '$root': move the project to a path without spaces and special characters"
    fi
    ((${#root} < 200)) || fail "catkin cannot build in a path of ${#root} characters: move the project to a shorter one"
    may_write "$root" || fail "'$root' is read-only, and the workspace in it is not set up: make it writable"
    if [[ -n $packages ]]; then
        check_system
        check_root "$packages"
    fi
}

check_system() {
    local ID=unknown VERSION_ID='' PRETTY_NAME=''
    # shellcheck source=/dev/null
    [[ ! -r $os_release ]] || . "$os_release"
    [[ -d $noetic || $ID-$VERSION_ID =~ ^(debian-1[123]|ubuntu-22\.04)$ ]] ||
        fail "this is ${PRETTY_NAME:-$ID}: the workspace needs $supported; elsewhere, use the container (docs/how_to/container.md)"
    is_among "$(uname -m)" x86_64 aarch64 ||
        fail "this machine is $(uname -m): the Python packages are there for x86_64 and aarch64 only"
    local glibc
    glibc=$(getconf GNU_LIBC_VERSION 2>/dev/null || true)
    is_at_least 2.17 "${glibc#glibc }" ||
        fail "the C library is ${glibc:-not glibc}: the Python packages need glibc 2.17 or newer; use the container (docs/how_to/container.md)"
}

is_at_least() { printf '%s\n' "$1" "$2" | sort --version-sort --check=quiet; } # VERSION OTHER: is OTHER no older?

check_root() { # NAMES: of the packages for whose sake
    sudo=()
    ((EUID)) || return 0
    local list="Debian packages are missing (${1//$'\n'/ })"
    command -v sudo >/dev/null || fail "$list: run this as root, or install sudo"
    sudo -n true 2>/dev/null || { [[ -t 0 ]] && sudo -v; } || fail "$list: run this as root, or where sudo lets you"
    sudo=(sudo)
}

check_python() {
    /usr/bin/python3 -c 'import sys; sys.exit(not (3, 8) <= sys.version_info[:2] <= (3, 13))' 2>/dev/null ||
        fail "/usr/bin/python3 is $(/usr/bin/python3 --version 2>&1 || true): the workspace needs Python 3.8 to 3.13"
}

take_turns() { # one set-up at a time; the lock ends with the set-up, or with the last process of one cut short
    exec 9<"$root/scripts/setup.sh"
    flock --nonblock 9 || step "Waiting for another set-up of this workspace" /dev/null flock 9
}

exchange() { # PATH OTHER: at once or, where the file system cannot do that, in three steps
    local code='import ctypes, os, sys
here, exchange = -100, 2 # AT_FDCWD, RENAME_EXCHANGE
path, other = map(os.fsencode, sys.argv[1:])
sys.exit(ctypes.CDLL(None).renameat2(here, path, here, other, exchange) != 0)'
    /usr/bin/python3 -c "$code" "$@" 2>/dev/null || { mv -T "$1" "$1.old" && mv -T "$2" "$1" && mv -T "$1.old" "$2"; }
}

give_up() { # SENTENCE LOG: ends with the reason that the log knows, else with the sentence and the log's end
    local reason
    reason=$(reason_in "$2")
    [[ -z $reason ]] || fail "$reason (see $2)"
    tail -n 20 "$2" | sed 's/^/  | /' >&2
    fail "$1 (see $2)"
}

has_room() { (($(df --output=avail "$root" | tail -n 1) >= 1024)); } # for a MB: without it, logs end before the reason

reason_in() { # LOG: what is no fault of the project's, in a sentence; nothing if it is none of these
    local proxy=${https_proxy:-${HTTPS_PROXY:-${http_proxy:-${HTTP_PROXY:-}}}}
    if grep -qE 'No space left on device|not have enough free space' "$1" || ! has_room; then
        print_line "the disk is full: make room and start again, it goes on from there"
    elif [[ -n $proxy ]] && grep -qiE 'ProxyError|Cannot connect to proxy|(connect|resolve).*proxy' "$1"; then
        print_line "the proxy ${proxy/#*@/} does not answer"
    elif grep -qE 'Temporary failure|Could not (resolve|connect)|Unable to connect|Network is unreachable|NewConnectionError|ConnectTimeout' "$1"; then
        print_line "no network: the packages could not be downloaded"
    elif grep -qE 'IncompleteRead|Connection broken|ReadTimeout|Hash Sum mismatch|Connection reset' "$1"; then
        print_line "a download broke off: start again, it goes on from there"
    fi
}
