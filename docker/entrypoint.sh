#!/usr/bin/env bash
# Usage: docker run [--rm] [-v FOLDER:/runs] home-service-robot [COMMAND [options]]
#
# COMMAND is the name of a script of the project, without .sh: home_service (the default), map_home,
# test_navigation, rehearse, test, doctor, ... or any program of the image. Options alone go to home_service.
# Run folders are made in /runs, which is all that has to be writable. The exit code is the command's.

set -euo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
runs=${RUNS:-/runs}

fail() {
    printf 'error: %s\n' "$*" >&2
    exit 2
}

is_writable() { # FOLDER
    local probe
    probe=$(mktemp -p "$1" .probe.XXXXXX 2>/dev/null) && rm -f "$probe"
}

use_cache() { # temporary files and the user's caches go to /tmp or, where even that is read-only, beside the runs
    local cache=/tmp/home-service-$UID
    if ! is_writable /tmp; then
        require_runs
        cache=$runs/.cache
    fi
    mkdir -p "$cache/tmp"
    export USER=${USER:-robot} HOME=$cache TMPDIR=$cache/tmp ROS_HOME=$cache/ros
}

require_runs() {
    is_writable "$runs" ||
        fail "user $(id -u) cannot write in $runs: let it, or use docker run --user \"\$(id -u):\$(id -g)\""
}

takes_output() { # COMMAND
    "$root/scripts/$1.sh" --help | grep -q -- '--output FOLDER'
}

[[ $# -gt 0 && $1 != -* ]] || set -- home_service "$@"
use_cache
cd "$root"
if [[ ! -e scripts/$1.sh ]]; then exec "$@"; fi
command=$1
shift
if takes_output "$command"; then
    require_runs
    set -- --output "$runs" "$@"
fi
exec "scripts/$command.sh" "$@"
