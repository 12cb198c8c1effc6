#!/usr/bin/env bash
# Usage: ./scripts/cockpit.sh [options] [RECORDING...]
#
# Shows a running ROS graph in the browser, and drives it: what rviz, Gazebo's window and rqt show, in one page.
# Prints the page's URL, with the token without which nothing is shown. The graph is that of ROS_MASTER_URI or,
# if nobody answers there, the newest one on this machine. Ctrl-C closes the page; the graph goes on.
# With bags, or folders of them or of runs: plays what was recorded, from wherever one likes, at any pace.
# Exit code: 0 success, 1 failure or no result.json, 2 bad input, 130 interrupted.
#
#   --web-port [ADDRESS:]PORT
#                    where the page is served (default: a free port of 127.0.0.1)
#   --tool NAME      open this tool at once (docs/how_to/watch_in_the_browser.md lists them)
#   --output FOLDER  where the run folder of a recording's show is made (default: ./runs)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command cockpit "$@"
