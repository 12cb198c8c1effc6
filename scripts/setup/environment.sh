# shellcheck shell=bash
# The ROS environment of the workspace, for the scripts and for scripts/shell.sh.

ros_environment() { # ROOT: what ROS needs in the environment, every socket on the loopback interface
    unset PYTHONHOME ROS_DISTRO
    export ROS_MASTER_URI=${ROS_MASTER_URI:-http://127.0.0.1:11311}
    [[ -n ${ROS_HOSTNAME:-} ]] || export ROS_IP=${ROS_IP:-127.0.0.1}
    # shellcheck source=/dev/null
    . "$1/devel/setup.bash"
    export PATH="$1/.venv/bin:$PATH"
    export ROS_HOME=${ROS_HOME:-$1/logs/ros}
    export ROS_LOG_DIR=${ROS_LOG_DIR:-$ROS_HOME/log}
}
