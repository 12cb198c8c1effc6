#!/usr/bin/env bash
# Usage: ./scripts/cockpit.sh [options] [RECORDING...]
#
# Show a running ROS graph in the browser and control it: the functions of rviz, Gazebo's window and rqt in one page.
# Prints the URL of the page with its access token. The graph is that of ROS_MASTER_URI or, without a master there,
# the newest one on this machine. Ctrl-C closes the page; the graph continues.
# With bags, folders of bags or run folders: plays the recording from any position at any speed.
# Exit code: 0 success, 1 failure or no result.json, 2 invalid input, 130 interrupted.
#
#   --web-port [ADDRESS:]PORT
#                    address of the page (default: a free port of 127.0.0.1)
#   --tool NAME      open this tool at once (docs/how_to/watch_in_the_browser.md lists them)
#   --output FOLDER  folder in which the run folder of a replay is created (default: ./runs)
#   --help           this text

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command cockpit "$@"
