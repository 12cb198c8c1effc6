# shellcheck shell=bash
# Usage: source scripts/shell.sh
#
# Turn an interactive bash into a shell of the workspace, after its set-up: rosnode, rostopic, rosrun, roslaunch ... with
# completion, roscd, rosls, rosed; the Python of .venv; ROS_MASTER_URI and ROS_IP on this machine, if they are not set.

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then
    printf 'error: this is not a command: source %s\n' "$0" >&2
    exit 2
fi

_enter_workspace() {
    local root completion
    root=$(cd -P -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
    if [[ ! -e $root/devel/setup.bash ]]; then
        printf 'error: the workspace is not set up: run %s/scripts/setup.sh first\n' "$root" >&2
        return 1
    fi
    # shellcheck source=scripts/setup/environment.sh
    . "$root/scripts/setup/environment.sh"
    ros_environment "$root"
    unset -f ros_environment use_own_kernels may_write user_cache copy_kernels numba_name
    completion=/usr/share/bash-completion/completions/rosbash # Debian's; Noetic's comes with devel/setup.bash
    # shellcheck source=/dev/null
    [[ ! -r $completion ]] || . "$completion"
}

_enter_workspace && unset -f _enter_workspace
