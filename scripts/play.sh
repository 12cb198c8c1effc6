#!/usr/bin/env bash
# Usage: ./scripts/play.sh SCENARIO [options]
#
# Run a scenario with one seed (docs/reference/scenarios.md), in one process, without ROS, and print the result, the
# same bit for bit as in evaluate.sh. SCENARIO is a file, or a name in scenarios/.
# With --over ros the graph of nodes runs it, as home_service.sh runs a mission, with a run folder.
# Performs the set-up if needed. Exit code: 0 success, 1 failure, 2 invalid input, 130 interrupted.
#
#   --seed N         seed (default: 0)
#   --planner NAME   local planner (default: that of the scenario); over ROS also official: the official move_base
#   --over WHAT      how it is run: process, or ros (default: process)
#   --help           this text
#
# Only with --over ros:
#   --speed N        1 real time, N times that, 0 as fast as the nodes keep up (default: 0, with --rviz or --web 1)
#   --rviz, --web    show the run in rviz, or in the browser; --web-port [ADDRESS:]PORT
#   --gif            also leave run.gif
#   --timeout S      time limit in wall-clock seconds (default: 900)
#   --output FOLDER  folder in which run folders are created (default: runs)

# shellcheck source=scripts/setup.sh
. "$(dirname -- "$(readlink -f -- "$0")")/setup.sh"
run_command play "$@"
