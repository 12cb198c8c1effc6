#!/usr/bin/env bash
# Usage: ./tests/rospy_versions.sh [FOLDER ...]
#
# Run the contract tests of src/rospy_transport with the rospy of Debian 11, 12 and 13, which apt downloads from
# the mirror that this machine is configured for, and with the package rospy in each FOLDER, for example
# clients/rospy/src of a clone of ros_comm. The rest of ROS and Python are those of this machine. The last line
# counts the versions: "N passed, N failed"; a release that the mirror does not have is named and not counted.

set -euo pipefail
shopt -s nullglob

usage() {
    awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' "$0"
}

if [[ ${1:-} == -h || ${1:-} == --help ]]; then
    usage
    exit 0
fi
here=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
python=$here/.venv/bin/python
[[ -x $python ]] || python=python3
keyring=/usr/share/keyrings/debian-archive-keyring.gpg
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
passed=0
failed=0

# apt with separate lists, cache and sources, so that the machine's stay as they are.
own_apt() { # FOLDER COMMAND...
    local folder=$1 command=$2
    shift 2
    "$command" -q -o Dir::Etc::sourcelist="$folder/sources.list" -o Dir::Etc::sourceparts=/dev/null \
        -o Dir::State::lists="$folder/lists" -o Dir::State::status="$folder/status" \
        -o Dir::Cache="$folder/cache" -o APT::Sandbox::User="$(id -un)" "$@"
}

download() { # RELEASE
    local folder=$work/$1
    mkdir -p "$folder"/{lists,cache/archives}/partial "$folder/tree"
    echo "deb [signed-by=$keyring] $mirror $1 main" > "$folder/sources.list"
    : > "$folder/status"
    (
        cd -- "$folder"
        own_apt "$folder" apt-get update && own_apt "$folder" apt-get download python3-rospy
    ) > "$folder/log" 2>&1 || return 1
    dpkg-deb -x "$folder"/python3-rospy_*.deb "$folder/tree"
}

run_tests() { # TITLE FOLDER
    echo "== $1"
    if PYTHONPATH="$2:$here/src/rospy_transport/src" "$python" -m pytest -p no:cacheprovider -W ignore \
        "$here/src/rospy_transport/test"; then
        ((passed += 1))
    else
        ((failed += 1))
    fi
}

# shellcheck disable=SC2016 # apt replaces the field
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' | sort -u | head -n 1)
for release in bullseye bookworm trixie; do
    if [[ -n $mirror ]] && download "$release"; then
        package=("$work/$release"/python3-rospy_*.deb)
        run_tests "$release: rospy $(dpkg-deb -f "${package[0]}" Version)" \
            "$work/$release/tree/usr/lib/python3/dist-packages"
    else
        echo "== $release: not available from the mirror of this machine"
        tail -n 3 "$work/$release/log" 2> /dev/null || true
    fi
done
for folder; do
    run_tests "$folder" "$(realpath -- "$folder")"
done
echo "$passed passed, $failed failed"
((failed == 0 && passed > 0))
