# shellcheck shell=bash
# The ROS environment of the workspace, for the scripts and for scripts/shell.sh.

ros_environment() { # ROOT [DEVEL]: what ROS needs in the environment, every socket on the loopback interface
    unset PYTHONHOME ROS_DISTRO
    export ROS_MASTER_URI=${ROS_MASTER_URI:-http://127.0.0.1:11311}
    [[ -n ${ROS_HOSTNAME:-} ]] || export ROS_IP=${ROS_IP:-127.0.0.1}
    # shellcheck source=/dev/null
    . "${2:-$1/devel}/setup.bash"
    export PATH="$1/.venv/bin:$PATH"
    if may_write "$1"; then : "${ROS_HOME:=$1/logs/ros}"; else : "${ROS_HOME:=$(user_cache)/ros}"; fi
    export ROS_HOME
    export ROS_LOG_DIR=${ROS_LOG_DIR:-$ROS_HOME/log}
    use_own_kernels "$1"
    use_known_versions "$1"
}

# Before roslaunch starts anything, roscore.xml runs two Python programs, one after the other, to determine ROS's versions.
# ROS_ETC_DIR is where it is looked for: in a folder like the one in effect, but with the answers.
use_known_versions() { # ROOT
    local etc=${ROS_ETC_DIR:-/etc/ros} known=$1/build/etc
    grep -qs 'command="rosversion' "$etc/roscore.xml" || return 0
    [[ -e $known/roscore.xml && ! $etc/roscore.xml -nt $known/roscore.xml ]] || know_versions "$etc" "$known" || return 0
    export ROS_ETC_DIR=$known
}

know_versions() { # ETC FOLDER
    local version distribution beside=$2.$$
    version=$(rosversion roslaunch) && distribution=$(rosversion -d) && mkdir "$beside" 2>/dev/null || return 1
    ln -s "$1"/* "$beside"
    rm "$beside/roscore.xml"
    sed "s/command=\"rosversion roslaunch\"/value=\"$version\"/; s/command=\"rosversion -d\"/value=\"$distribution\"/" \
        "$1/roscore.xml" >"$beside/roscore.xml"
    rm -rf "$2"
    mv -T "$beside" "$2" 2>/dev/null || rm -rf "$beside" # another run was faster
    [[ -e $2/roscore.xml ]]
}

# Numba reads what it has compiled beside the sources only if it may also write there. Who may not, as another user or
# on a read-only disk, would compile all of them again: that takes longer than the nodes wait for each other.
use_own_kernels() { # ROOT: such a user has copies, made again whenever the set-up has compiled
    local cache compiled=$1/build/.kernels
    [[ -z ${NUMBA_CACHE_DIR:-} && -e $compiled ]] && ! may_write "$1/src" && cache=$(user_cache) || return 0
    cache=$cache/kernels/$(numba_name "$1")
    cmp -s "$compiled" "$cache/.kernels" || copy_kernels "$1" "$cache"
    export NUMBA_CACHE_DIR=$cache
}

may_write() { [[ -w $1 ]]; } # FOLDER

user_cache() { # prints a folder that is this user's alone
    local folder
    for folder in "${XDG_CACHE_HOME:-${HOME:-}/.cache}/home-service-robot" "${TMPDIR:-/tmp}/home-service-robot-$UID"; do
        (umask 077 && mkdir -p "$folder") 2>/dev/null || continue
        [[ -O $folder && ! -L $folder && -w $folder ]] && printf '%s\n' "$folder" && return 0
    done
    return 1
}

copy_kernels() { # ROOT CACHE: whole or not at all; others may be copying, too
    local compiled own beside=$2.$$
    rm -rf "$beside"
    find "$1/src" -name '*.nbi' -printf '%h\n' | sort -u | while IFS= read -r compiled; do
        own=$beside/$(numba_name "${compiled%/__pycache__}")
        mkdir -p "$own"
        cp "$compiled"/*.nb[ic] "$own"
    done
    mkdir -p "$beside"
    cp "$1/build/.kernels" "$beside/.kernels"
    cmp -s "$1/build/.kernels" "$2/.kernels" || rm -rf "$2" 2>/dev/null || true
    mv -T "$beside" "$2" 2>/dev/null || rm -rf "$beside" # another script was faster
}

numba_name() { # FOLDER: as numba names the folder in its cache for the sources in this one
    printf '%s_%s' "${1##*/}" "$(printf %s "$1" | sha1sum | cut -d ' ' -f 1)"
}
