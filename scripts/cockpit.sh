#!/usr/bin/env bash
# Usage: ./scripts/cockpit.sh [options]
#
# Shows a running ROS graph in the browser, and drives it: what rviz, Gazebo's window and rqt show, in one page.
# Prints the page's URL, with the token without which nothing is shown. The graph is that of ROS_MASTER_URI or,
# if nobody answers there, the newest one on this machine. Ctrl-C closes the page; the graph goes on.
# Exit code: 0 success, 1 failure, 2 bad input, 130 interrupted.
#
#   --web-port [ADDRESS:]PORT
#                    where the page is served (default: a free port of 127.0.0.1)
#   --tool NAME      open this tool at once (docs/cockpit.md lists them)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command cockpit "$@"
