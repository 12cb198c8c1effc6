# shellcheck shell=bash
# What the scripts share: messages, long steps that Ctrl-C ends, the ROS environment, the way to a command.

# Started in the background of another script, bash ignores SIGINT for good; only a new process can undo that.
if [[ $(trap -p INT) == "trap -- '' SIGINT" ]] && env --default-signal=INT true 2>/dev/null; then
    exec env --default-signal=INT "$BASH" "$0" "$@"
fi

set -euo pipefail
root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
readonly root
# shellcheck disable=SC2034 # used by setup.sh
readonly noetic=/opt/ros/noetic
# shellcheck source=scripts/setup/environment.sh
. "$root/scripts/setup/environment.sh"
step_pid=
clock_pid=
aside_pid=

print_line() { printf '%s\n' "$*"; }

fail() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}

usage() { # prints the usage of the script that was started: generated from its command's options, or its head comment
    local file
    file=$root/scripts/usage/$(basename -- "$(readlink -f -- "$0")" .sh).txt
    if [[ -e $file ]]; then cat "$file"; else sed -n '2,/^$/ s/^# \{0,1\}//p' "$0"; fi
}

is_among() { # WORD LIST...
    local word=$1 other
    shift
    for other in "$@"; do [[ $other == "$word" ]] && return 0; done
    return 1
}

interrupted() { # EXIT_CODE: ends the step that is running, then this script
    trap '' INT TERM HUP
    end_group "$clock_pid"
    if [[ -n $step_pid ]]; then
        as_root_if_needed kill -INT -- "-$step_pid"
        local tenths=0
        while kill -0 -- "-$step_pid" 2>/dev/null && ((tenths++ < 50)); do sleep 0.1; done
        as_root_if_needed kill -KILL -- "-$step_pid"
    fi
    printf '\ninterrupted; the next start goes on from here\n' >&2
    exit "$1"
}
trap 'interrupted 130' INT
trap 'interrupted 143' TERM
trap 'interrupted 129' HUP
trap 'end_group "$aside_pid"' EXIT

as_root_if_needed() { "$@" 2>/dev/null || sudo -n "$@" 2>/dev/null || true; }

end_group() { # PID: asked more than once, since bash loses a signal that comes while it starts a process
    local hundredths=0
    [[ -n $1 ]] || return 0
    while kill -0 "$1" 2>/dev/null; do
        ((hundredths++ % 100)) || kill -- "-$1" 2>/dev/null || true
        sleep 0.01
    done
    wait "$1" 2>/dev/null || true
}

step() { # TITLE LOG COMMAND...: runs the command, shows how long it takes, returns its exit code
    local title=$1 log=$2 status=0 started=$SECONDS here=$BASHPID
    shift 2
    print_line "$title ..."
    # Own process groups, and waiting with `wait`, let a signal sent to this shell alone end the step at once.
    set -m
    show_time "$started" "$here" "$log" 8<&- 9<&- &
    clock_pid=$!
    "$@" >>"$log" 2>&1 </dev/null &
    step_pid=$!
    set +m
    wait "$step_pid" || status=$?
    step_pid=
    end_group "$clock_pid"
    clock_pid=
    ((status)) || print_line "  done in $((SECONDS - started)) s"
    return "$status"
}

show_time() { # STARTED PARENT LOG: until the parent has ended, be it killed
    local seconds=0 parent
    while sleep 1 && read -r _ _ _ parent _ <"/proc/$BASHPID/stat" && ((parent == $2)); do
        ((++seconds % 15)) || print_line "  ... $((SECONDS - $1)) s$(share_built "$3")"
    done
}

share_built() { # LOG: of a build by catkin, first of the packages and then, as in "[ 14%] Building", of the targets
    awk '/^-- ~~ +traversing [0-9]+ packages/ { packages = $4 }
        /^-- \+\+\+ processing catkin package/ { configured++ }
        /^\[ *[0-9]+%\]/ { share = substr($0, 2) + 0; is_building = 1 }
        END {
            if (is_building) print ", " share " %"
            else if (packages) print ", " configured + 0 " of " packages " packages configured"
        }' "$1"
}

start_aside() { # LOG COMMAND...: goes on beside the next steps, until finish_aside
    set -m
    "${@:2}" >>"$1" 2>&1 </dev/null &
    aside_pid=$!
    set +m
}

finish_aside() { # TITLE: waits, and returns the exit code of what was started aside
    local status=0
    step "$1" /dev/null await_end_of "$aside_pid"
    wait "$aside_pid" || status=$?
    aside_pid=
    return "$status"
}

await_end_of() { # PID: a process that has ended stays in the table where nobody reaps orphans, as in many containers
    local state
    while read -r _ _ state _ <"/proc/$1/stat" && [[ $state != Z ]]; do sleep 0.1; done
}

enter_workspace() {
    check_temporary_files
    hold_build
    set +u
    ros_environment "$root" "$HOME_SERVICE_BUILD"
    set -u
}

# What is run keeps the build that it starts with, by a lock that it inherits; the scripts that it starts use the same one.
hold_build() { # sets HOME_SERVICE_BUILD
    if is_inside && lock_build "$HOME_SERVICE_BUILD"; then return; fi
    for _ in {1..100}; do # another set-up may have finished meanwhile
        HOME_SERVICE_BUILD=$(readlink -f "$root/devel")
        if lock_build "$HOME_SERVICE_BUILD" && [[ $(readlink -f "$root/devel") == "$HOME_SERVICE_BUILD" ]]; then break; fi
        sleep 0.05
    done
    export HOME_SERVICE_BUILD
}

lock_build() { exec 8<"${1%/devel}" && flock --shared --nonblock 8; } # DEVEL

is_inside() { # was this started by something that runs in this workspace?
    [[ ${HOME_SERVICE_BUILD:-} == "$root"/* && -e $HOME_SERVICE_BUILD/.set-up ]]
}

check_temporary_files() { # the environment and the nodes need some
    local file reason
    if file=$(mktemp 2>&1); then
        reason=$(head -c 65536 /dev/zero 2>&1 >"$file") || reason=${reason##*: }
        rm -f "$file"
        [[ -z $reason ]] || fail "${TMPDIR:-/tmp}: no temporary files can be written there ($reason)"
    else
        fail "${TMPDIR:-/tmp}: no temporary files can be made there (${file##*: })"
    fi
}

answer_help() { # ARGUMENT...
    if is_among --help "$@" || is_among -h "$@"; then
        usage
        exit 0
    fi
}

is_asked_for_web() { # ARGUMENT...
    is_among --web "$@" || is_among --web-port "${@%%=*}"
}

is_drawing_given() { # ARGUMENT...: a DXF or IFC file
    local argument
    for argument; do [[ ${argument,,} != *.dxf && ${argument,,} != *.ifc ]] || return 0; done
    return 1
}

run_command() { # PACKAGE NAME ARGUMENT...: a command, after the set-up it needs
    answer_help "$@"
    local extras=()
    if is_among --rviz "$@" && [[ -n ${DISPLAY:-} ]]; then extras=(rviz); fi
    case $1 in
        laboratory) extras+=(laboratory) ;;
        home_service_gym) extras+=(gymnasium) ;;
        service) extras+=(service) ;;
        home_builder) ! is_drawing_given "$@" || extras+=(drawings) ;;
    esac
    if [[ $2 == cockpit ]] || { [[ $1 != home_builder ]] && is_asked_for_web "$@"; }; then extras+=(cockpit); fi
    set_up "${extras[@]}"
    enter_workspace
    exec python3 -m "$@"
}
